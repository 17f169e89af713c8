//! Whether facts and data describe one law.

use super::program::varying;
use super::{LawData, Node};
use crate::error::ErrorKind;
use crate::law::LawFacts;

/// Why facts and data do not describe one law.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DataError {
    /// The counts of levels differ.
    #[error("the facts have {facts} levels, and the data {data}")]
    Levels {
        /// Levels of the facts.
        facts: usize,
        /// Levels of the data.
        data: usize,
    },
    /// There is not one piece more than there are levels.
    #[error("{levels} levels have {} pieces between them, and the data {pieces}", .levels + 1)]
    Pieces {
        /// Levels of the facts.
        levels: usize,
        /// Pieces of the data.
        pieces: usize,
    },
    /// A level or a piece has another number of derivatives than the law has arguments.
    #[error("{derivatives} derivatives by {arguments} arguments")]
    Derivatives {
        /// Derivatives of the level or the piece.
        derivatives: usize,
        /// Arguments of the law.
        arguments: usize,
    },
    /// A node is an argument that the law does not have.
    #[error("node {node} is argument {argument} of {arguments}")]
    Argument {
        /// Position of the node.
        node: usize,
        /// Index of the argument, from zero.
        argument: usize,
        /// Arguments of the law.
        arguments: usize,
    },
    /// An operand does not come before its use.
    #[error("node {node} does not come after its operand {operand}")]
    Operand {
        /// Position of the node.
        node: usize,
        /// Position of the operand.
        operand: usize,
    },
    /// A level or a piece names a node that is not there.
    #[error("there is no node {node}; there are {nodes}")]
    NoNode {
        /// The position named.
        node: usize,
        /// How many nodes there are.
        nodes: usize,
    },
    /// A level depends on gap or rate.
    #[error("level {level} depends on gap or rate")]
    LevelVaries {
        /// Position of the level.
        level: usize,
    },
}

crate::error::room_error! {
    DataError, |_| ErrorKind::Model;
    Levels { facts, data }
    Pieces { levels, pieces }
    Derivatives { derivatives, arguments }
    Argument { node, argument, arguments }
    Operand { node, operand }
    NoNode { node, nodes }
    LevelVaries { level }
    ;
}

/// Whether facts and data describe one law, so that programs can be made of the data.
///
/// # Errors
/// The first thing that does not fit.
pub(super) fn check(facts: &LawFacts, data: &LawData) -> Result<(), DataError> {
    let levels = facts.levels.len();
    if data.levels.len() != levels {
        return Err(DataError::Levels {
            facts: levels,
            data: data.levels.len(),
        });
    }
    if data.pieces.len() != levels + 1 {
        let pieces = data.pieces.len();
        return Err(DataError::Pieces { levels, pieces });
    }
    let arguments = facts.arguments.len();
    check_nodes(&data.nodes, arguments)?;
    let varies = varying(&data.nodes);
    for (index, level) in data.levels.iter().enumerate() {
        check_outputs(&[level.value], &level.by_argument, &varies, arguments)?;
        let mut all = level.by_argument.iter().chain([&level.value]);
        if all.any(|&node| varies[node]) {
            return Err(DataError::LevelVaries { level: index });
        }
    }
    for piece in data.pieces.iter() {
        let own = [piece.force, piece.by_gap, piece.by_rate];
        check_outputs(&own, &piece.by_argument, &varies, arguments)?;
    }
    Ok(())
}

/// Operands come before their use, and arguments are there.
fn check_nodes(nodes: &[Node], arguments: usize) -> Result<(), DataError> {
    for (node, &of) in nodes.iter().enumerate() {
        if let Node::Argument(argument) = of
            && argument >= arguments
        {
            return Err(DataError::Argument {
                node,
                argument,
                arguments,
            });
        }
        let late = of.operands().into_iter().flatten().find(|&at| at >= node);
        if let Some(operand) = late {
            return Err(DataError::Operand { node, operand });
        }
    }
    Ok(())
}

/// What a level or a piece names is there, a derivative for each argument.
fn check_outputs(
    own: &[usize],
    by_argument: &[usize],
    nodes: &[bool],
    arguments: usize,
) -> Result<(), DataError> {
    let derivatives = by_argument.len();
    if derivatives != arguments {
        return Err(DataError::Derivatives {
            derivatives,
            arguments,
        });
    }
    let nodes = nodes.len();
    match own.iter().chain(by_argument).find(|&&node| node >= nodes) {
        Some(&node) => Err(DataError::NoNode { node, nodes }),
        None => Ok(()),
    }
}
