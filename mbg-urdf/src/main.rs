//! The command `mbg-urdf`.

use std::process::ExitCode;

const HELP: &str = "\
Prints a robot's URDF file as a component in the language of mbg!

usage: mbg-urdf [--model NAME] FILE

  FILE          the URDF file; its path is named in the component's documentation
  --model NAME  prints a model of this name too, with the robot's base at rest
  --help        prints this text

The component goes to standard output. What of the file is not in it is named on standard error with its line.

example:
  mbg-urdf robots/arm.urdf > robots/arm.mbg
and then, in Rust, with the path from the root of the crate:
  mbg! {
      include \"robots/arm.mbg\";
      pub model Bench {
          causality componentwise;
          gravity [0.0, 0.0, -9.81];
          1 base[6];
          Sf ground[6] { flow: 0.0 } -> base;
          arm: Arm (base);
          output angles[7] = arm.coordinates;
      }
  }
";

/// What the command line asks for.
enum Request {
    Help,
    Convert { file: String, model: Option<String> },
}

fn main() -> ExitCode {
    match request(std::env::args().skip(1)) {
        Ok(Request::Help) => {
            print!("{HELP}");
            ExitCode::SUCCESS
        }
        Ok(Request::Convert { file, model }) => converted(&file, model.as_deref()),
        Err(mistake) => {
            eprintln!("mbg-urdf: {mistake}\n\n{HELP}");
            ExitCode::from(2)
        }
    }
}

fn request(mut arguments: impl Iterator<Item = String>) -> Result<Request, String> {
    let (mut file, mut model) = (None, None);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--help" | "-h" => return Ok(Request::Help),
            "--model" => {
                let name = arguments.next().ok_or("`--model` needs a name")?;
                let letters = name
                    .chars()
                    .all(|it| it.is_ascii_alphanumeric() || it == '_');
                if !letters || !name.starts_with(|it: char| it.is_ascii_alphabetic()) {
                    return Err(format!("`{name}` cannot be the name of a model"));
                }
                model = Some(name);
            }
            _ if argument.starts_with('-') => return Err(format!("`{argument}` is not known")),
            _ if file.is_some() => return Err("one file at a time".to_owned()),
            _ => file = Some(argument),
        }
    }
    let file = file.ok_or("a file is missing")?;
    Ok(Request::Convert { file, model })
}

fn converted(file: &str, model: Option<&str>) -> ExitCode {
    let text = match std::fs::read_to_string(file) {
        Ok(text) => text,
        Err(reason) => {
            eprintln!("{file}: {reason}");
            return ExitCode::FAILURE;
        }
    };
    match mbg_urdf::convert(&text, file, model) {
        Ok(found) => {
            for remark in &found.remarks {
                eprintln!("{file}:{remark}");
            }
            print!("{}", found.text);
            ExitCode::SUCCESS
        }
        Err(remark) => {
            eprintln!("{file}:{remark}");
            ExitCode::FAILURE
        }
    }
}
