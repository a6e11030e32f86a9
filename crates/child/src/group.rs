//! A program with everything it starts: on Unix a process group, ended as one.

use crate::environment;
use std::collections::BTreeSet;
use std::io;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Leaders of the groups that run.
static RUNNING: Mutex<BTreeSet<u32>> = Mutex::new(BTreeSet::new());

fn running() -> MutexGuard<'static, BTreeSet<u32>> {
    RUNNING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends every program that was started, for a command that is interrupted and ends: no other is started afterwards. A
/// group of its own hears nothing of the Ctrl-C at a terminal.
pub fn end_all() {
    let groups = running();
    for leader in groups.iter() {
        kill_group(*leader);
    }
    std::mem::forget(groups);
}

/// A program with everything it starts; ended with this value.
pub(crate) struct Group {
    /// The program.
    pub leader: Child,
}

impl Group {
    /// Starts a program whose output and complaints are read.
    pub fn start(command: &mut Command) -> io::Result<Self> {
        environment::clean(command);
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(command, 0);
        let mut groups = running();
        let leader = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
        groups.insert(leader.id());
        Ok(Self { leader })
    }

    /// Waits for the program's end, but no longer than this.
    pub fn wait(&mut self, longest: Duration) -> Option<ExitStatus> {
        let until = Instant::now() + longest;
        loop {
            match self.leader.try_wait() {
                Ok(Some(status)) => return Some(status),
                Ok(None) if Instant::now() < until => std::thread::sleep(Duration::from_millis(5)),
                _ => return None,
            }
        }
    }
}

impl Drop for Group {
    fn drop(&mut self) {
        kill_group(self.leader.id());
        let _ = self.leader.kill();
        let _ = self.leader.wait();
        running().remove(&self.leader.id());
    }
}

/// Ends a group, where anything is left of it. Its number is not given to another one as long as it has a member.
#[cfg(unix)]
fn kill_group(leader: u32) {
    let leader = i32::try_from(leader).ok().and_then(rustix::process::Pid::from_raw);
    if let Some(leader) = leader {
        let _ = rustix::process::kill_process_group(leader, rustix::process::Signal::KILL);
    }
}

/// There are no groups to end: the program is ended alone.
#[cfg(not(unix))]
fn kill_group(_leader: u32) {}
