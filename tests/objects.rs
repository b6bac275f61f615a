//! Objects linked into a C program: every function of every level against the JIT, bit for bit.

#![cfg(all(target_arch = "x86_64", target_os = "linux"))]

#[path = "objects/fixture.rs"]
mod fixture;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use imp::codegen::object::Level;
use imp::codegen::object::Target;
use imp::codegen::object::emit;

const ALL: [Level; 3] = [Level::V2, Level::V3, Level::V4];

fn gcc(folder: &Path, arguments: &[&str]) {
    let output = Command::new("gcc").args(arguments).current_dir(folder).output().expect("gcc runs");
    assert!(output.status.success(), "gcc {arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// The highest level of this machine.
fn machine() -> Level {
    let has_v3 = is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("fma")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("lzcnt");
    let has_v4 = is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512cd")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("avx512vl");
    match (has_v3, has_v4) {
        (true, true) => Level::V4,
        (true, false) => Level::V3,
        (false, _) => Level::V2,
    }
}

/// Exported are the documented symbols and no other; of the C library `unit.o` needs at most `fma`.
fn symbols(folder: &Path, cases: &[fixture::Case], needs_fma: bool) {
    let output = Command::new("nm").args(["-g", "unit.o"]).current_dir(folder).output().expect("nm runs");
    let (mut defined, mut missing) = (BTreeSet::new(), BTreeSet::new());
    for line in String::from_utf8(output.stdout).unwrap().lines() {
        match line.split_whitespace().collect::<Vec<_>>()[..] {
            ["U", name] => missing.insert(name.to_owned()),
            [_, _, name] => defined.insert(name.to_owned()),
            _ => panic!("{line}"),
        };
    }
    let names = cases.iter().map(|case| &case.routine.symbol);
    let exported = names.flat_map(|name| ["", "_columns", "_packets"].map(|suffix| format!("{name}{suffix}")));
    assert_eq!(defined, exported.chain(["unit_level", "unit_abi"].map(String::from)).collect());
    let library = if needs_fma { vec!["fma", "fmaf"] } else { vec![] };
    assert_eq!(missing, library.into_iter().map(String::from).collect());
}

/// Objects for either architecture are ELF files for it. In the folder `OBJECTS`, if it is set, they are left for
/// `tests/objects/cross.sh`, which runs them on emulated processors.
#[test]
fn objects_for_other_machines() {
    let own = tempfile::tempdir().unwrap();
    let folder = std::env::var_os("OBJECTS").map_or(own.path().to_owned(), Into::into);
    let cases = fixture::cases();
    fixture::write(&cases, &folder);
    // The machine's number stands at byte 18 of an ELF header: EM_X86_64 and EM_AARCH64.
    for (name, target, machine) in [("x86_64.o", Target::X86_64(ALL.to_vec()), 62), ("aarch64.o", Target::Aarch64, 183)]
    {
        let object = emit(&fixture::unit(&cases, target)).unwrap();
        assert!(object.starts_with(b"\x7fELF") && object[18] == machine, "{name}");
        fs::write(folder.join(name), object).unwrap();
    }
}

#[test]
fn equal_units_give_equal_bytes() {
    let cases = fixture::cases();
    for target in [Target::X86_64(ALL.to_vec()), Target::Aarch64] {
        let unit = fixture::unit(&cases[..10], target);
        assert_eq!(emit(&unit).unwrap(), emit(&unit).unwrap());
    }
}

#[test]
fn what_does_not_fit_is_an_error() {
    let cases = fixture::cases();
    let good = || fixture::unit(&cases[..1], Target::X86_64(ALL.to_vec()));
    assert!(emit(&good()).is_ok());
    let mut bad = good();
    bad.target = Target::X86_64(Vec::new());
    assert!(emit(&bad).is_err(), "no level");
    let mut bad = good();
    bad.routines.push(bad.routines[0].clone());
    assert!(emit(&bad).is_err(), "one name twice");
    let mut bad = good();
    bad.routines[0].variables += 1;
    assert!(emit(&bad).is_err(), "a coordinate that the program has not");
    let mut bad = good();
    bad.abi = "unit_level".to_owned();
    assert!(emit(&bad).is_err(), "a name of a function for data");
}

#[test]
fn every_level_agrees_with_the_jit_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let cases = fixture::cases();
    fixture::write(&cases, folder);
    let driver = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/objects/driver.c");
    let driver = driver.to_str().unwrap();
    gcc(folder, &["-std=gnu11", "-Wall", "-Wextra", "-Werror", "-O1", "-I.", "-c", driver, "-o", "driver.o"]);
    gcc(folder, &["-std=gnu11", "-Wall", "-Wextra", "-Werror", "-I.", "-c", "table.c", "-o", "table.o"]);
    let alone = ALL.iter().map(|&level| vec![level]);
    for levels in alone.chain([ALL.to_vec()]) {
        let target = Target::X86_64(levels.clone());
        let object = emit(&fixture::unit(&cases, target)).unwrap();
        fs::write(folder.join("unit.o"), object).unwrap();
        symbols(folder, &cases, levels.contains(&Level::V2));
        gcc(folder, &["driver.o", "table.o", "unit.o", "-o", "driver", "-lm", "-lpthread", "-Wl,--fatal-warnings"]);
        let Some(level) = levels.iter().copied().filter(|&level| level <= machine()).max() else {
            println!("skipped: this machine has no level of {levels:?}");
            continue;
        };
        let level = level.number().to_string();
        let output = Command::new("./driver").args(["fixture.bin", &level]).current_dir(folder).output().unwrap();
        assert!(
            output.status.success(),
            "{levels:?}: {}, {:?}",
            String::from_utf8_lossy(&output.stdout),
            output.status
        );
    }
}
