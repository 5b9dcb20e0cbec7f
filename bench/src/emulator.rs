//! The emulated board: QEMU with the program `hil` of `firmware/`.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use gimbal_servo::Digest;

use crate::link::{Link, LinkError};

/// The emulator's program.
pub const PROGRAM: &str = "qemu-system-arm";
/// Target of the default board.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// How frames come to the emulated board.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Transport {
    /// Two pipes that the program reads and writes by semihosting.
    Fifo,
    /// The emulated serial port.
    Uart,
}

impl Transport {
    /// The program that speaks it.
    #[must_use]
    pub fn program(self) -> &'static str {
        match self {
            Self::Fifo => "hil_fifo",
            Self::Uart => "hil",
        }
    }
}

/// A running emulator; it ends with this.
#[derive(Debug)]
struct Running {
    child: Child,
    /// Its pipes and sockets.
    folder: tempfile::TempDir,
}

impl Drop for Running {
    fn drop(&mut self) {
        // A program that waits in a semihosting call hears no other signal.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The emulated board behind a link.
pub struct Emulated {
    running: Running,
    link: Box<dyn Link>,
    image: u64,
}

/// Version of the emulator, if it is installed.
#[must_use]
pub fn version() -> Option<String> {
    let output = Command::new(PROGRAM).arg("--version").output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    output.status.success().then(|| text.lines().next().unwrap_or_default().to_owned())
}

/// The workspace that holds `firmware/`: above the working directory, or where this program was built.
#[must_use]
pub fn workspace() -> Option<PathBuf> {
    let here = std::env::current_dir().ok();
    let built = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let above = here.iter().flat_map(|here| here.ancestors().map(Path::to_owned));
    above.chain([built]).find(|folder| folder.join("firmware/boards/an386.toml").exists())
}

/// Builds the program for the default board.
///
/// # Errors
/// No source, no compiler for the target, or it does not build.
pub fn build(transport: Transport) -> Result<PathBuf, LinkError> {
    let source = workspace().ok_or_else(|| {
        LinkError::new("the firmware's source is not here", "run in the project's folder, or give --image FILE")
    })?;
    let mend = "`gimbal doctor` says what is missing; `--target host` needs no board";
    let program = transport.program();
    let target_dir = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| source.join("target"), PathBuf::from);
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .current_dir(&source)
        .args(["build", "--quiet", "--release", "--package", "gimbal-firmware", "--bin", program, "--target", TARGET])
        .output()
        .map_err(|error| LinkError::new(format!("cargo cannot be started: {error}"), mend))?;
    if output.status.success() {
        return Ok(target_dir.join(TARGET).join("release").join(program));
    }
    // `cargo xtask test` may have built it by another compiler.
    let kept = target_dir.join("boards/an386").join(program);
    if kept.exists() {
        return Ok(kept);
    }
    let told = String::from_utf8_lossy(&output.stderr);
    let first = told.lines().find(|line| line.starts_with("error")).unwrap_or("cargo build failed").to_owned();
    Err(LinkError::new(format!("the firmware does not build: {first}"), mend))
}

#[cfg(unix)]
impl Emulated {
    /// Starts an image on the emulated default board.
    ///
    /// # Errors
    /// No emulator, or it does not start.
    pub fn start(image: &Path, transport: Transport) -> Result<Self, LinkError> {
        use crate::link::{Fifo, Stream};
        use std::os::unix::net::UnixListener;

        let mend = "`gimbal doctor` says what is missing; `--target host` needs no emulator";
        let fail = |what: &str, error: &dyn std::fmt::Display| LinkError::new(format!("{what}: {error}"), mend);
        let image = image.canonicalize().map_err(|error| fail(&image.display().to_string(), &error))?;
        let mut digest = Digest::default();
        digest.add(&std::fs::read(&image).map_err(|error| fail(&image.display().to_string(), &error))?);
        let folder =
            tempfile::Builder::new().prefix("gimbal-hil-").tempdir().map_err(|error| fail("no folder", &error))?;
        let mut command = Command::new(PROGRAM);
        command
            .current_dir(folder.path())
            .args(["-machine", "mps2-an386", "-nographic", "-monitor", "none"])
            .args(["-semihosting-config", "enable=on,target=native"])
            .arg("-kernel")
            .arg(&image)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        // Its own group: Ctrl-C is for the bench, which ends it.
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let spawn = |command: &mut Command| command.spawn().map_err(|error| fail(PROGRAM, &error));
        let (child, link): (Child, Box<dyn Link>) = match transport {
            Transport::Fifo => {
                let fifo = Fifo::create(folder.path())?;
                (spawn(command.args(["-serial", "none"]))?, Box::new(fifo))
            }
            Transport::Uart => {
                let path = folder.path().join("uart");
                let listener = UnixListener::bind(&path).map_err(|error| fail("no socket", &error))?;
                listener.set_nonblocking(true).map_err(|error| fail("no socket", &error))?;
                let mut child = spawn(command.args(["-serial", "unix:uart"]))?;
                let socket =
                    accept(&listener, &mut child).map_err(|error| fail("the emulator does not connect", &error))?;
                (child, Box::new(Stream::local(socket, "the emulated serial port")?))
            }
        };
        Ok(Self { running: Running { child, folder }, link, image: digest.value() })
    }

    /// Number of the emulator's process.
    #[must_use]
    pub fn process(&self) -> u32 {
        self.running.child.id()
    }

    /// Says that the emulator has ended, if it has.
    fn explain(&mut self, error: LinkError) -> LinkError {
        // The pipe closes a little before the process is gone.
        std::thread::sleep(Duration::from_millis(20));
        match self.running.child.try_wait() {
            Ok(Some(status)) => LinkError::new(format!("the emulator has ended ({status})"), "start again"),
            _ => error,
        }
    }
}

/// Waits for the emulator to connect, for some seconds.
#[cfg(unix)]
fn accept(
    listener: &std::os::unix::net::UnixListener,
    child: &mut Child,
) -> std::io::Result<std::os::unix::net::UnixStream> {
    let begun = Instant::now();
    loop {
        match listener.accept() {
            Ok((socket, _)) => {
                socket.set_nonblocking(false)?;
                return Ok(socket);
            }
            Err(error) if error.kind() != std::io::ErrorKind::WouldBlock => return Err(error),
            Err(error) if begun.elapsed() > Duration::from_secs(10) || child.try_wait()?.is_some() => {
                return Err(error);
            }
            Err(_) => std::thread::sleep(Duration::from_millis(2)),
        }
    }
}

#[cfg(unix)]
impl Link for Emulated {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        self.link.send(bytes).map_err(|error| self.explain(error))
    }

    fn receive(&mut self, bytes: &mut Vec<u8>, wait: Duration) -> Result<(), LinkError> {
        self.link.receive(bytes, wait).map_err(|error| self.explain(error))
    }

    fn describe(&self) -> String {
        let version = version().unwrap_or_else(|| PROGRAM.to_owned());
        // Dropped with the emulator.
        let _ = self.running.folder.path();
        format!("mps2-an386 in {version}, {}", self.link.describe())
    }

    fn image(&self) -> Option<u64> {
        Some(self.image)
    }
}
