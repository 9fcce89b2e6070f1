"""Tests of the check on small crates that are written for them."""

import tempfile
import unittest
from pathlib import Path

import ceilings
import check
import python
import rust


def modules(files):
    """Returns the modules of a crate with these files."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            file = Path(folder, "src", name)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        return rust.crate(Path(folder))


def names_in_circles(files):
    return [sorted(file.name for file in circle) for circle, _ in check.circles(modules(files))]


class Circles(unittest.TestCase):
    def test_a_circle_through_a_group_and_a_name_exported_again(self):
        files = {
            "lib.rs": "mod a; mod b;",
            "a.rs": "use crate::{\n    b::{deep::{D, E}},\n};\npub struct A;",
            "b/mod.rs": "mod deep; mod user; pub use user::U;",
            "b/deep.rs": "use super::U; pub struct D; pub struct E;",
            "b/user.rs": "fn f() { crate::a::A; } pub struct U;",
        }
        self.assertEqual(names_in_circles(files), [["a.rs", "deep.rs", "user.rs"]])

    def test_a_parent_that_calls_its_child(self):
        files = {
            "lib.rs": "mod a;",
            "a/mod.rs": "mod b; pub struct A; fn f() { b::g() }",
            "a/b.rs": "use super::A; pub fn g() {}",
        }
        (circle, steps), = check.circles(modules(files))
        self.assertEqual(len(circle), 2)
        self.assertEqual(sorted((one.name, line) for one, line, _ in steps),
                         [("b.rs", 1), ("mod.rs", 1)])

    def test_tests_comments_and_strings_import_nothing(self):
        files = {
            "lib.rs": "mod a; mod b;",
            "a.rs": "use crate::b::B;\npub struct A;",
            "b.rs": 'pub struct B; // crate::a::A\nconst C: &str = "crate::a::A";\n'
                    "#[cfg(test)]\nmod tests { use crate::a::A; }",
        }
        self.assertEqual(names_in_circles(files), [])


    def test_python_files_that_import_each_other(self):
        files = {
            "__init__.py": "from ._a import A\n",
            "_a.py": "from . import _b, errors\n",
            "_b.py": "def f():\n    from ._c import C\n",
            "_c.py": "import typing\nif typing.TYPE_CHECKING:\n    from ._a import A\n",
            "errors.py": "from os import path\n",
        }
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                Path(folder, name).write_text(text)
            (circle, _), = check.circles(python.package(Path(folder)))
        self.assertEqual([file.name for file in circle], ["_a.py", "_b.py", "_c.py"])


class Ceilings(unittest.TestCase):
    def test_they_fall_and_never_rise(self):
        before = {"public-items": 7, "lines.a": 100, "lines.gone": 50}
        sizes = {"public-items": 8, "lines.a": 40, "lines.new": 101}
        after = ceilings.lowered(before, sizes)
        self.assertEqual(after, {"public-items": 7, "lines.a": 50, "lines.new": 150})
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "ceilings.toml")
            self.assertEqual(ceilings.read(file), {})
            ceilings.write(file, after)
            self.assertEqual(ceilings.read(file), after)
        fault, = ceilings.faults(after, sizes)
        self.assertIn("public-items is 8, above its ceiling 7", fault)
        self.assertIn("give the reason", fault)
        self.assertIn("has no ceiling", *ceilings.faults(before, {"lines.new": 1}))

    def test_a_name_in_two_files_is_counted_once(self):
        files = {"lib.rs": "mod a; mod b;", "a.rs": "pub struct A; enum B {}", "b.rs": "trait A {}"}
        twice = check.names_of_several_files({"crate": modules(files)})
        self.assertEqual(list(twice), ["A"])


class Joints(unittest.TestCase):
    def test_conform_knows_none(self):
        with tempfile.TemporaryDirectory() as folder:
            text = "let shares = !a.is_disjoint(&b);\n/// The joint.\npub fn part() {}\n"
            for crate in ("conform", "arm"):
                file = Path(folder, "crates", crate, "src/a.rs")
                file.parent.mkdir(parents=True)
                file.write_text(text)
            fault, = check.joints(Path(folder))
        self.assertTrue(fault.startswith("crates/conform/src/a.rs:2: "))


class Functions(unittest.TestCase):
    def test_lengths_count_from_fn_to_the_closing_brace(self):
        text = rust.code("trait T { fn a(); }\nfn b<'a>(c: char) -> [u8; 2]\nwhere\n"
                         "    T: 'a,\n{\n    let d = '}';\n    c\n}\n")
        self.assertEqual(list(rust.functions(text)), [("b", 2, 7)])


if __name__ == "__main__":
    unittest.main()
