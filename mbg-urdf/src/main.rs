//! The command `mbg-urdf`.

use std::process::ExitCode;

use mbg_urdf::{Options, Remark};

const HELP: &str = "\
Prints a robot's URDF file as a component in the language of mbg!

usage: mbg-urdf [--model NAME] [--frame LINK]… [--stops] [--right-angles RAD] FILE

  FILE                the URDF file; its path is named in the component's documentation
  --model NAME        prints a model of this name too, with the robot's base at rest
  --frame LINK        adds a junction LINK_frame at the place of this link, for forces, contacts and velocities there
  --stops             puts a stop at the lower and the upper limit of each joint that has them; without it, joints turn on
  --right-angles RAD  takes angles this near to a multiple of a right angle for it: 1e-5 where a file says 1.5708,
                      which leaves fewer operations; 1e-9 unless told otherwise
  --help              prints this text

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
    Convert {
        file: String,
        model: Option<String>,
        frames: Vec<String>,
        stops: bool,
        right_angles: f64,
    },
}

fn main() -> ExitCode {
    match request(std::env::args().skip(1)) {
        Ok(Request::Help) => {
            print!("{HELP}");
            ExitCode::SUCCESS
        }
        Ok(Request::Convert {
            file,
            model,
            frames,
            stops,
            right_angles,
        }) => {
            let frames: Vec<&str> = frames.iter().map(String::as_str).collect();
            converted(
                &file,
                &Options {
                    model: model.as_deref(),
                    right_angles,
                    frames: &frames,
                    stops,
                },
            )
        }
        Err(mistake) => {
            eprintln!("mbg-urdf: {mistake}\n\n{HELP}");
            ExitCode::from(2)
        }
    }
}

fn request(mut arguments: impl Iterator<Item = String>) -> Result<Request, String> {
    let (mut file, mut model, mut frames) = (None, None, Vec::new());
    let Options {
        mut right_angles,
        mut stops,
        ..
    } = Options::default();
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
            "--frame" => frames.push(
                arguments
                    .next()
                    .ok_or("`--frame` needs the name of a link")?,
            ),
            "--stops" => stops = true,
            "--right-angles" => {
                let angle = arguments.next().and_then(|it| it.parse().ok());
                let small = angle.filter(|it| (0.0..0.1).contains(it));
                right_angles =
                    small.ok_or("`--right-angles` needs an angle below 0.1 rad, such as 1e-5")?;
            }
            _ if argument.starts_with('-') => return Err(format!("`{argument}` is not known")),
            _ if file.is_some() => return Err("one file at a time".to_owned()),
            _ => file = Some(argument),
        }
    }
    let file = file.ok_or("a file is missing")?;
    Ok(Request::Convert {
        file,
        model,
        frames,
        stops,
        right_angles,
    })
}

fn converted(file: &str, options: &Options<'_>) -> ExitCode {
    let text = match std::fs::read_to_string(file) {
        Ok(text) => text,
        Err(reason) => {
            eprintln!("{file}: {reason}");
            return ExitCode::FAILURE;
        }
    };
    match mbg_urdf::convert(&text, file, options) {
        Ok(found) => {
            tell(file, &found.remarks);
            print!("{}", found.text);
            ExitCode::SUCCESS
        }
        Err(remark) => {
            eprintln!("{file}:{remark}");
            ExitCode::FAILURE
        }
    }
}

/// Writes remarks, each once with the first line that it is about.
fn tell(file: &str, remarks: &[Remark]) {
    let is_first = |place: &usize| {
        let mut before = remarks[..*place].iter();
        before.all(|it| it.text != remarks[*place].text)
    };
    for place in (0..remarks.len()).filter(is_first) {
        let first = &remarks[place];
        let alike = remarks[place..].iter().filter(|it| it.text == first.text);
        match alike.count() - 1 {
            0 => eprintln!("{file}:{first}"),
            1 => eprintln!("{file}:{first}, and once more below"),
            more => eprintln!("{file}:{first}, and {more} times more below"),
        }
    }
}
