//! Parquet files, as pandas and LeRobot write them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::data_type::{DataType, DoubleType, FloatType, Int64Type};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use reachtube_recordings::{
    ColumnSettings, GapLimit, Logged, LoggedOptions, NamedColumns, Wanted, read_logged,
    read_logged_runs, read_named, table_files,
};

type Levels<'a> = Option<&'a [i16]>;

fn column<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, std::fs::File>,
    values: &[T::T],
    [defined, repeated]: [Levels<'_>; 2],
) {
    let mut column = group.next_column().unwrap().unwrap();
    column.typed::<T>().write_batch(values, defined, repeated).unwrap();
    column.close().unwrap();
}

fn write(
    path: &Path,
    schema: &str,
    columns: impl Fn(&mut SerializedRowGroupWriter<'_, std::fs::File>),
) {
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    let schema = Arc::new(parse_message_type(schema).unwrap());
    let file = std::fs::File::create(path).unwrap();
    let mut writer = SerializedFileWriter::new(file, schema, Default::default()).unwrap();
    // Two groups of rows.
    for _ in 0..2 {
        let mut group = writer.next_row_group().unwrap();
        columns(&mut group);
        group.close().unwrap();
    }
    writer.close().unwrap();
}

/// Writes two episodes of 3 samples of two joints, which follow with an error of 1 mrad.
fn lerobot(root: &Path) -> PathBuf {
    let path = root.join("data/chunk-000/file-000.parquet");
    let schema = "message schema {
        optional group action (LIST) { repeated group list { optional float element; } }
        optional group observation.state (LIST) { repeated group list { optional float element; } }
        optional float timestamp;
        optional int64 episode_index;
        optional group next.images (LIST) { repeated group list { optional float element; } }
    }";
    let episode = std::cell::Cell::new(0);
    write(&path, schema, |group| {
        let lists = |defined: &[i16], repeated: &[i16], values: &[f32], group: &mut _| {
            column::<FloatType>(group, values, [Some(defined), Some(repeated)]);
        };
        let (all, twice) = ([3; 6], [0, 1, 0, 1, 0, 1]);
        lists(&all, &twice, &[0.5, 1.5, 0.6, 1.6, 0.7, 1.7], group);
        lists(&all, &twice, &[0.501, 1.501, 0.601, 1.601, 0.701, 1.701], group);
        column::<FloatType>(group, &[0.0, 0.1, 0.2], [Some(&[1; 3]), None]);
        column::<Int64Type>(group, &[episode.get(); 3], [Some(&[1; 3]), None]);
        // Lists of several lengths are no columns.
        lists(&[3, 3, 3, 1], &[0, 1, 0, 0], &[1.0, 2.0, 3.0], group);
        episode.set(7);
    });
    std::fs::create_dir_all(root.join("meta/episodes")).unwrap();
    std::fs::write(root.join("meta/episodes/file-000.parquet"), "no recording").unwrap();
    let info = r#"{"features": {"action": {"names": {"motors": ["pan.pos", "lift.pos"]}},
        "observation.state": {"names": [["pan.pos", "lift.pos"]]}, "timestamp": {"names": null}}}"#;
    std::fs::write(root.join("meta/info.json"), info).unwrap();
    path
}

fn options<'a>(columns: &'a ColumnSettings, joints: &'a [String]) -> LoggedOptions<'a> {
    LoggedOptions {
        robot: None,
        joints,
        columns,
        gains: false,
        wanted: Wanted::Commands,
        gap_limit: GapLimit::Seconds(f64::INFINITY),
        until: None,
    }
}

#[test]
fn a_folder_of_lerobot_has_a_recording_for_each_episode() {
    let folder = tempfile::tempdir().unwrap();
    let path = lerobot(folder.path());
    let files = [path];
    assert_eq!(table_files(folder.path()).unwrap(), files);
    let columns = ColumnSettings::default();
    let runs = read_logged_runs(&files, &options(&columns, &[])).unwrap();
    assert_eq!(
        runs.iter().map(|(run, _)| run.as_deref()).collect::<Vec<_>>(),
        [Some("0"), Some("7")]
    );
    for (_, Logged { run, command, understood, .. }) in &runs {
        assert_eq!(understood.as_ref().unwrap().joints, ["pan", "lift"]);
        // Numbers of 32 bits keep their value.
        assert_eq!(run.times, [0.0, 0.1, 0.2].map(|t: f32| (f64::from(t) * 1e12).trunc() / 1e12));
        assert_eq!(*command, [0.5, 1.5, 0.6, 1.6, 0.7, 1.7].map(|value: f32| f64::from(value)));
        assert_eq!(run.q(2), [0.701, 1.701].map(|value: f32| f64::from(value)));
    }
    assert_ne!(runs[0].1.run.sha256, runs[1].1.run.sha256);
    // Joints may be chosen, in any order.
    let joints = ["lift".to_string()];
    let runs = read_logged_runs(&files, &options(&columns, &joints)).unwrap();
    assert_eq!(runs[1].1.command, [1.5, 1.6, 1.7].map(|value: f32| f64::from(value)));
    let [note] = &runs[1].1.notes[..] else { panic!("{:?}", runs[1].1.notes) };
    assert!(note.contains("next.images have") && note.contains("are left out"), "{note}");
    // Without their description, values of lists have numbers; a note names what cannot be read.
    let info = folder.path().join("meta/info.json");
    std::fs::write(&info, "{\"features\": {").unwrap();
    let pattern: ColumnSettings = "r=action_{},q=observation.state_{},time_unit=s".parse().unwrap();
    let runs = read_logged_runs(&files, &options(&pattern, &[])).unwrap();
    assert_eq!(runs[0].1.command.len(), 6);
    let note = &runs[0].1.notes[1];
    assert!(note.contains("info.json: EOF") && note.contains("have numbers"), "{note}");
    std::fs::remove_file(info).unwrap();
    let (seconds, second) = ("time_unit=s".parse().unwrap(), ["1".to_string()]);
    let runs = read_logged_runs(&files, &options(&seconds, &second)).unwrap();
    assert_eq!(runs[0].1.command, [1.5, 1.6, 1.7].map(|value: f32| f64::from(value)));
    // The recordings of a file have one unit.
    let text = "t,episode,q,q_d\n0,1,0.1,0.1\n0.01,1,0.2,0.2\n0,2,90,90\n0.01,2,80,80\n";
    let mixed = [folder.path().join("mixed.csv")];
    std::fs::write(&mixed[0], text).unwrap();
    let error = read_logged_runs(&mixed, &options(&columns, &[])).unwrap_err();
    assert!(error[0].to_string().contains("run 2 seems to have other units"), "{}", error[0]);
    std::fs::write(&mixed[0], text.replace(",2,80", ",1,80")).unwrap();
    let error = read_logged_runs(&mixed, &options(&columns, &[])).unwrap_err();
    assert!(error[0].to_string().contains("run 1 continues"), "{}", error[0]);
    // One recording has no two times 0.
    let error = read_logged(&files, &options(&columns, &[])).unwrap_err();
    assert!(error[0].to_string().contains("file-000.parquet:5: timestamp = 0"), "{}", error[0]);
}

#[test]
fn a_changed_file_is_read_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let files = [lerobot(folder.path())];
    let bytes = std::fs::read(&files[0]).unwrap();
    let columns = ColumnSettings::default();
    for at in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[at] ^= 1 << (at % 8);
        std::fs::write(&files[0], changed).unwrap();
        let _ = read_logged_runs(&files, &options(&columns, &[]));
    }
}

#[test]
fn tables_of_pandas_are_read_to_the_nanosecond() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.parquet");
    let schema = "message schema {
        optional int64 time (TIMESTAMP(NANOS,true));
        optional double y;
        required double speed;
        optional binary note (STRING);
    }";
    let stamp = std::cell::Cell::new(1_700_000_000_000_000_001);
    write(&path, schema, |group| {
        let stamps = [stamp.get(), stamp.get() + 1_000_003];
        column::<Int64Type>(group, &stamps, [Some(&[1; 2]), None]);
        column::<DoubleType>(group, &[0.1 + 0.2, 1e-300], [Some(&[1; 2]), None]);
        column::<DoubleType>(group, &[1.0, 2.0], [None, None]);
        let texts = ["x", "y"].map(parquet::data_type::ByteArray::from);
        column::<parquet::data_type::ByteArrayType>(group, &texts, [Some(&[1; 2]), None]);
        stamp.set(stamp.get() + 2_000_000);
    });
    let [required, optional] = [vec!["y".to_string()], vec![]];
    let columns = NamedColumns { required: &required, optional: &optional, step: None };
    let (runs, sha256) = read_named(&path, &columns).unwrap();
    assert_eq!(runs[0].times, [0.0, 0.001000003, 0.002, 0.003000003]);
    assert_eq!(runs[0].required, [0.1 + 0.2, 1e-300, 0.1 + 0.2, 1e-300]);
    assert_eq!(sha256.len(), 64);
    // A value that is missing, and a file that is cut short.
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    let error = read_named(&path, &columns).unwrap_err();
    assert!(error[0].to_string().contains("the Parquet file cannot be read"), "{}", error[0]);
    write(&path, "message schema { optional double t; optional double y; }", |group| {
        column::<DoubleType>(group, &[0.0, 1.0], [Some(&[1, 1]), None]);
        column::<DoubleType>(group, &[0.5], [Some(&[1, 0]), None]);
    });
    let error = read_named(&path, &columns).unwrap_err();
    assert!(error[0].to_string().contains("log.parquet:3: column \"y\" is empty"), "{}", error[0]);
}
