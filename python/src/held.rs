//! Parts of results that are held by the whole: an object of Python that shows one orbit keeps its branch, and copies nothing.

use std::ops::Deref;
use std::sync::Arc;

use hertzian::bifurcation::{Diagram, Solutions};
use hertzian::{Branch, Event, Model, Point, System};

use crate::request::Request;

/// A diagram.
#[derive(Clone)]
pub enum DiagramRef {
    Own(Arc<Diagram>),
    OfSolutions(Arc<Solutions>),
}

impl Deref for DiagramRef {
    type Target = Diagram;

    fn deref(&self) -> &Diagram {
        match self {
            Self::Own(diagram) => diagram,
            Self::OfSolutions(solutions) => &solutions.diagram,
        }
    }
}

/// A branch by itself, or one of a diagram.
#[derive(Clone)]
pub enum BranchRef {
    Own(Arc<Branch>),
    In(DiagramRef, usize),
}

impl Deref for BranchRef {
    type Target = Branch;

    fn deref(&self) -> &Branch {
        match self {
            Self::Own(branch) => branch,
            Self::In(diagram, number) => &diagram.branches[*number].branch,
        }
    }
}

/// What an orbit belongs to.
#[derive(Clone)]
pub enum Owner {
    Branch(BranchRef),
    Request(Arc<Asked>),
}

/// What an orbit that is on no branch was asked for by.
pub struct Asked {
    pub system: Arc<dyn System>,
    pub request: Request,
}

impl Owner {
    pub fn request(system: &Arc<dyn System>, request: &Request) -> Self {
        let (system, request) = (Arc::clone(system), request.clone());
        Self::Request(Arc::new(Asked { system, request }))
    }

    pub fn model(&self) -> Model {
        match self {
            Self::Branch(branch) => branch.model.clone(),
            Self::Request(asked) => Model::of(&asked.system),
        }
    }
}

/// An orbit of a branch by its number, that of an event, or one by itself.
#[derive(Clone)]
pub enum PointRef {
    Of(BranchRef, usize),
    AtEvent(BranchRef, usize),
    Own(Arc<Point>, Owner),
}

impl PointRef {
    pub fn own(point: Point, owner: Owner) -> Self {
        Self::Own(Arc::new(point), owner)
    }

    pub fn owner(&self) -> Owner {
        match self {
            Self::Of(branch, _) | Self::AtEvent(branch, _) => Owner::Branch(branch.clone()),
            Self::Own(_, owner) => owner.clone(),
        }
    }
}

impl Deref for PointRef {
    type Target = Point;

    fn deref(&self) -> &Point {
        match self {
            Self::Of(branch, index) => &branch.points[*index],
            Self::AtEvent(branch, index) => &branch.events[*index].point,
            Self::Own(point, _) => point,
        }
    }
}

/// An event of a branch.
#[derive(Clone)]
pub struct EventRef {
    pub branch: BranchRef,
    pub index: usize,
}

impl Deref for EventRef {
    type Target = Event;

    fn deref(&self) -> &Event {
        &self.branch.events[self.index]
    }
}
