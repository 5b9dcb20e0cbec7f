//! Sockets: TCP, and the local one behind an emulated serial port.

use std::io::{Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::Duration;

use super::{Link, LinkError, read_once};

/// Time for a connection, and for the other end to take what is sent.
const PATIENCE: Duration = Duration::from_secs(3);

/// A socket.
#[derive(Debug)]
pub struct Stream<S> {
    socket: S,
    name: String,
    wait: Option<Duration>,
    set_wait: fn(&S, Duration) -> std::io::Result<()>,
}

impl Stream<TcpStream> {
    /// Connects to `host:port`.
    ///
    /// # Errors
    /// No such host, or nobody listens there.
    pub fn connect(address: &str) -> Result<Self, LinkError> {
        let mend = "give host:port of something that listens and speaks docs/wire.md";
        let fail = |error: std::io::Error| LinkError::new(format!("{address}: cannot connect: {error}"), mend);
        let mut last = None;
        for place in address.to_socket_addrs().map_err(fail)? {
            match TcpStream::connect_timeout(&place, PATIENCE) {
                Ok(socket) => {
                    // A tick waits for its answer: small frames must not wait for company.
                    socket.set_nodelay(true).map_err(fail)?;
                    socket.set_write_timeout(Some(PATIENCE)).map_err(fail)?;
                    let set_wait = |socket: &TcpStream, wait| socket.set_read_timeout(Some(wait));
                    return Ok(Self { socket, name: format!("TCP {address}"), wait: None, set_wait });
                }
                Err(error) => last = Some(fail(error)),
            }
        }
        Err(last.unwrap_or_else(|| LinkError::new(format!("{address}: no such host"), mend)))
    }
}

#[cfg(unix)]
impl Stream<std::os::unix::net::UnixStream> {
    /// A local socket that is connected already.
    ///
    /// # Errors
    /// It cannot be set up.
    pub fn local(socket: std::os::unix::net::UnixStream, name: &str) -> Result<Self, LinkError> {
        socket
            .set_write_timeout(Some(PATIENCE))
            .map_err(|error| LinkError::new(format!("{name}: {error}"), "start again"))?;
        let set_wait = |socket: &std::os::unix::net::UnixStream, wait| socket.set_read_timeout(Some(wait));
        Ok(Self { socket, name: name.to_owned(), wait: None, set_wait })
    }
}

impl<S: Read + Write> Link for Stream<S> {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        self.socket.write_all(bytes).map_err(|error| gone(&self.name, &error))
    }

    fn receive(&mut self, bytes: &mut Vec<u8>, wait: Duration) -> Result<(), LinkError> {
        let wait = wait.max(Duration::from_millis(1));
        if self.wait != Some(wait) {
            (self.set_wait)(&self.socket, wait).map_err(|error| gone(&self.name, &error))?;
            self.wait = Some(wait);
        }
        if read_once(&mut self.socket, bytes).map_err(|error| gone(&self.name, &error))? {
            return Ok(());
        }
        Err(LinkError::new(format!("{}: the other end has closed the link", self.name), REPAIR))
    }

    fn describe(&self) -> String {
        self.name.clone()
    }
}

const REPAIR: &str = "see that the computer still runs, and start again";

fn gone(name: &str, error: &std::io::Error) -> LinkError {
    LinkError::new(format!("{name}: the link is gone: {error}"), REPAIR)
}
