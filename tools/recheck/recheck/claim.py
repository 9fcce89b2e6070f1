"""What a model file claims, and which of it was not judged.

The claim is about the recordings that the file lists, in the notion of its settings. What is
missing for a verdict on it is named, and then the answer is undecided at best.
"""

from dataclasses import dataclass, field

from .errors import BadInput

NOTIONS = {
    "hull": "each state in the interval hull of the reachable set",
    "phase-plane": "each position and its velocity together in the reachable set",
    "exact": "all states together in the reachable set",
}


@dataclass
class Claim:
    """The notion that a model claims, what is missing for a verdict, what the verdict rests on, and
    what else was found."""

    notion: str
    missing: list = field(default_factory=list)
    conditions: list = field(default_factory=list)
    facts: list = field(default_factory=list)

    @classmethod
    def of_model(cls, model):
        """Returns the claim of a model file."""
        notion = model.settings.get("notion", "hull")
        if notion not in NOTIONS:
            raise BadInput(f"settings.notion is {notion!r}, not one of {', '.join(NOTIONS)}")
        return cls(notion)

    def needs_points(self, model, certificate, every):
        """Notes what is missing for the points of the notion."""
        if self.notion == "hull":
            return
        if model.polynomials is not None:
            self.missing.append("points of a model that is not linear are not judged here")
        elif certificate is None:
            self.missing.append("the certificate that `conform --certificate` writes; give it with "
                                "--certificate")
        elif self.notion == "exact" and certificate.notion != "exact":
            self.missing.append(f"a certificate of the notion exact: this one is of "
                                f"{certificate.notion}")
        elif every > 1:
            self.missing.append(f"the points of all samples: --every {every} leaves most out")

    def rests_on_inputs(self, error):
        """Notes that inputs were computed in doubles."""
        self.conditions.append(
            f"the inputs computed here differ by at most {error:g} N m from the inputs that define "
            f"the model, which is an estimate of rounding and not proved"
        )

    def code(self, code):
        """Returns the exit code of a verdict, for what was judged and what is missing."""
        return 2 if code == 0 and self.missing else code
