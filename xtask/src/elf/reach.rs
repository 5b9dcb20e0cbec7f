//! Everything that a function can reach, and the most stack that takes.

use super::code::Function;
use anyhow::{Context, Result, bail};
use std::collections::{BTreeMap, BTreeSet};

/// What is reachable from one function.
pub(crate) struct Reach {
    /// Every function, the root among them, with the path of calls that leads there first.
    pub(crate) functions: Vec<(Function, String)>,
    /// Most stack of the root and everything below it.
    pub(crate) stack_bytes: u32,
    /// The calls that take the most stack.
    pub(crate) deepest: String,
}

impl Reach {
    /// From the function named `root`; recursion is an error, for then no stack bound exists.
    pub(crate) fn from(functions: &BTreeMap<u32, Function>, root: &str) -> Result<Self> {
        let (&address, _) = functions
            .iter()
            .find(|(_, function)| function.names.iter().any(|name| name == root))
            .with_context(|| format!("no function {root}"))?;
        let mut walk = Walk { functions, done: BTreeMap::new(), found: Vec::new(), path: Vec::new() };
        let (stack_bytes, deepest) = walk.visit(address)?;
        Ok(Self { functions: walk.found, stack_bytes, deepest })
    }

    pub(crate) fn code_bytes(&self) -> u32 {
        self.functions.iter().map(|(function, _)| function.bytes).sum()
    }
}

/// Addresses of everything that the function at `root` reaches, the ways into a panic left out.
pub(crate) fn addresses(functions: &BTreeMap<u32, Function>, root: u32) -> BTreeSet<u32> {
    let mut found = BTreeSet::new();
    let mut open = vec![root];
    while let Some(address) = open.pop() {
        let Some(function) = functions.get(&address) else { continue };
        let panics = function.names.iter().any(|name| name.contains("panic"));
        if !panics && found.insert(address) {
            open.extend(&function.calls);
        }
    }
    found
}

struct Walk<'a> {
    functions: &'a BTreeMap<u32, Function>,
    /// Stack below and including each function that is finished, and the calls that take it.
    done: BTreeMap<u32, (u32, String)>,
    found: Vec<(Function, String)>,
    path: Vec<u32>,
}

impl Walk<'_> {
    fn visit(&mut self, address: u32) -> Result<(u32, String)> {
        if let Some(known) = self.done.get(&address) {
            return Ok(known.clone());
        }
        let function = self.functions.get(&address).with_context(|| format!("no function at {address:#x}"))?;
        if self.path.contains(&address) {
            bail!("{} calls itself: {}", function.name(), self.path_text(address));
        }
        self.found.push((function.clone(), self.path_text(address)));
        self.path.push(address);
        let mut below = (0, String::new());
        for &callee in &function.calls {
            let (bytes, calls) = self.visit(callee)?;
            if bytes > below.0 {
                below = (bytes, format!(" > {calls}"));
            }
        }
        self.path.pop();
        let own = function.frame_bytes;
        let total = (own + below.0, format!("{} {own}{}", function.name(), below.1));
        self.done.insert(address, total.clone());
        Ok(total)
    }

    fn path_text(&self, last: u32) -> String {
        let all = self.path.iter().chain([&last]);
        let names: Vec<String> = all.filter_map(|at| self.functions.get(at)).map(Function::name).collect();
        names.join(" > ")
    }
}
