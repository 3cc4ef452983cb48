//! What stands there: welded, indexed triangles with named components and edge adjacency.
//!
//! Real models are open, crowded and flipped. Nothing is repaired here and nothing refused: the mesh is
//! what the file says, [`report`] says what is wrong with it, and the shadow of dirty parts is right by
//! the rule in [`crate::volume`].

mod adjacency;
#[doc(hidden)]
pub mod patches;
mod planes;
#[doc(hidden)]
pub mod report;
pub(crate) mod scan;
mod together;
mod weld;

pub(crate) use adjacency::lowest;

use glam::{DVec3, DVec4, Vec3};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::{Arc, OnceLock};
use together::CornerGroups;
use weld::WeldedPart;

/// One component as a model file gives it: triangles of one node and one material, before welding.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// `node/material`, or `node` where the node has one material.
    pub name: String,
    /// The names by which `casts` and `receives` may mean it: of its node, mesh and material.
    pub aliases: Vec<String>,
    /// Metres in the world frame.
    pub positions: Vec<DVec3>,
    /// Counter-clockwise seen from outside (mirroring transforms already undone).
    pub triangles: Vec<[u32; 3]>,
    /// Where the file's own numbers are coarser than a millimetre.
    pub coarse: Vec<CornerPrecision>,
}

impl Part {
    /// Errs where a corner is no point, or a triangle has one that is not there.
    fn check(&self) -> Result<(), MeshError> {
        if !self.positions.par_iter().all(|corner| corner.is_finite()) {
            return Err(MeshError::NoPoint(self.name.clone()));
        }
        let corners = self.positions.len();
        let missing = self.triangles.par_iter().flatten_iter().find_any(|corner| **corner as usize >= corners);
        missing.map_or(Ok(()), |&corner| Err(MeshError::NoCorner { name: self.name.clone(), corner, corners }))
    }
}

/// A run of corners, and how coarse the numbers are that a file writes them with.
#[derive(Clone, Debug, PartialEq)]
pub struct CornerPrecision {
    /// Of the part's positions.
    pub corners: Range<u32>,
    /// From one number to the next, metres in the world.
    pub step_m: f64,
    /// Whether that is so since single precision holds no larger numbers better; else they are whole numbers.
    pub is_float: bool,
}

/// A named part of the mesh, a run of its faces. Adjacency never crosses it, and no vertex is shared across it.
#[derive(Clone, Debug)]
pub struct Component {
    /// `node/material`, or `node` where the node has one material.
    pub name: String,
    /// The names by which `casts` and `receives` may mean it: of its node, mesh and material.
    pub aliases: Vec<String>,
    /// Its faces.
    pub faces: Range<u32>,
    /// Its edges.
    pub edges: Range<u32>,
    /// Triangles that the file has and the mesh has not, as welding made two of their corners one: the lines that are left.
    pub collapsed: Arc<[[u32; 2]]>,
    /// How many of those have three corners apart in the file: welding has changed what the file says.
    pub flattened: usize,
    /// The coarsest of its corners, but for strays that lie far off; none where the file writes all of them finely.
    pub coarse: Option<CornerPrecision>,
}

/// A face at an edge: which one, and whether it runs along the edge (from its first vertex to its second) or against it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Incidence(u32);

impl Incidence {
    fn new(face: u32, against: bool) -> Self {
        Incidence(face << 1 | u32::from(against))
    }

    /// The face.
    pub fn face(self) -> u32 {
        self.0 >> 1
    }

    /// +1 where the face runs along the edge, −1 where it runs against it.
    pub fn direction(self) -> i32 {
        1 - 2 * (self.0 & 1) as i32
    }
}

/// Welded triangles with planes and adjacency, `f32` around `origin`. A copy shares all that is large.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// World position of the local origin; whole metres, unless it was given.
    pub origin: DVec3,
    /// Metres around `origin`; shared by the meshes that were taken from this one.
    pub vertices: Arc<Vec<Vec3>>,
    /// Three vertices a face, counter-clockwise seen from outside; grouped by component.
    pub faces: Arc<Vec<[u32; 3]>>,
    planes: Arc<OnceLock<Vec<DVec4>>>,
    /// The lowest and highest corner of a box around what stands together, around `origin`; what lies outside is far off.
    home: [Vec3; 2],
    /// The parts.
    pub components: Vec<Component>,
    /// Two vertices an edge, the lower first; grouped by component.
    pub edges: Arc<Vec<[u32; 2]>>,
    /// Where each edge's faces begin in `incidences`; one longer than `edges`.
    edge_first: Arc<Vec<u32>>,
    incidences: Arc<Vec<Incidence>>,
}

/// Why there is no mesh.
#[derive(Debug, thiserror::Error)]
pub enum MeshError {
    /// Vertices and faces are counted in 32 bits, one of which says which way a face runs along an edge.
    #[error("the models hold {0} triangles, more than the {max} that Gnomon counts; leave parts out", max = Mesh::MOST_FACES)]
    TooLarge(usize),
    /// `f32` around one origin cannot hold it.
    #[error(
        "'{name}' reaches {km:.0} km from the middle of the models, where half a metre is lost; place it nearer to them, \
         leave it out of the file, or check its scale"
    )]
    TooWide {
        /// The component that reaches farthest.
        name: String,
        /// How far.
        km: f64,
    },
    /// `f32` around the origin that was given cannot hold it.
    #[error(
        "'{name}' reaches {km:.0} km from the given origin, where half a metre is lost; give an origin near the parts"
    )]
    FarFromOrigin {
        /// The component that reaches farthest.
        name: String,
        /// How far; infinite where the origin is no point.
        km: f64,
    },
    /// A coordinate is infinite or no number.
    #[error("'{0}' has a corner that is no point; give finite coordinates in metres")]
    NoPoint(String),
    /// A triangle names a corner that its part does not have.
    #[error("'{name}' has a triangle with corner {corner}, and only {corners} corners, counted from 0")]
    NoCorner {
        /// The part.
        name: String,
        /// The corner that is not there.
        corner: u32,
        /// How many there are.
        corners: usize,
    },
}

impl Mesh {
    /// The most faces a mesh can have.
    pub const MOST_FACES: usize = 1 << 30;
    /// The farthest a vertex may lie from the origin, metres: there `f32` still tells half a metre apart, which is
    /// coarse, but a model so large has that in its file already.
    pub const FARTHEST_M: f64 = 8.0e6;

    /// Welds the parts, each for itself, and finds planes and adjacency. The origin is the middle of what stands together.
    ///
    /// # Errors
    /// [`MeshError`]
    pub fn build(parts: Vec<Part>) -> Result<Mesh, MeshError> {
        Self::built(parts, None)
    }

    /// As [`Mesh::build`], around an origin that is given, such as another mesh's. Positions keep what `f32` holds of their
    /// distance from it: 1 km away that is 0.06 mm. Whole metres lose nothing themselves.
    ///
    /// # Errors
    /// [`MeshError`]; [`MeshError::FarFromOrigin`] beyond [`Mesh::FARTHEST_M`].
    pub fn build_around(parts: Vec<Part>, origin: DVec3) -> Result<Mesh, MeshError> {
        Self::built(parts, Some(origin))
    }

    fn built(parts: Vec<Part>, given: Option<DVec3>) -> Result<Mesh, MeshError> {
        let triangles: usize = parts.iter().map(|part| part.triangles.len()).sum();
        let corners: usize = parts.iter().map(|part| part.positions.len()).sum();
        if triangles.max(corners / 3) > Self::MOST_FACES {
            return Err(MeshError::TooLarge(triangles));
        }
        parts.iter().try_for_each(Part::check)?;
        let together = CornerGroups::of(&parts);
        let home = together.home().unwrap_or_default();
        let origin = given.unwrap_or(((home.0 + home.1) / 2.0).round());
        let reach = |part: &Part| {
            let reach = |&corner: &DVec3| (corner - origin).abs().max_element();
            let reach = part.positions.par_iter().map(reach).reduce(|| 0.0, f64::max);
            if origin.is_finite() { reach } else { f64::INFINITY }
        };
        let reaches = parts.iter().map(|part| (reach(part), &part.name));
        if let Some((reach, name)) = reaches.max_by(|one, other| one.0.total_cmp(&other.0))
            && reach > Self::FARTHEST_M
        {
            let (name, km) = (name.clone(), reach / 1000.0);
            return Err(match given {
                Some(_) => MeshError::FarFromOrigin { name, km },
                None => MeshError::TooWide { name, km },
            });
        }

        let weld = |part: Part| of_part(part, origin, &together);
        let welded: Vec<(Component, WeldedPart)> = parts.into_par_iter().map(weld).collect();
        let (mut vertices, mut faces) = (Vec::new(), Vec::new());
        let mut components = Vec::with_capacity(welded.len());
        let corners: usize = welded.iter().map(|(_, welded)| welded.vertices.len()).sum();
        for (component, welded) in welded {
            let (vertex, face) = (vertices.len() as u32, faces.len() as u32);
            if components.is_empty() {
                // often there is but one
                (vertices, faces) = (welded.vertices, welded.faces);
                vertices.reserve_exact(corners - vertices.len());
                faces.reserve_exact(triangles - faces.len());
            } else {
                vertices.extend(welded.vertices);
                faces.extend(welded.faces.iter().map(|face| face.map(|corner| vertex + corner)));
            }
            components.push(Component {
                faces: face..faces.len() as u32,
                collapsed: welded.collapsed.iter().map(|line| line.map(|end| vertex + end)).collect(),
                ..component
            });
        }
        let home = [home.0, home.1].map(|corner| (corner - origin).as_vec3());
        Ok(Mesh::of((origin, home), vertices.into(), faces, components, OnceLock::new()))
    }

    fn of(
        (origin, home): (DVec3, [Vec3; 2]),
        vertices: Arc<Vec<Vec3>>,
        faces: Vec<[u32; 3]>,
        components: Vec<Component>,
        planes: OnceLock<Vec<DVec4>>,
    ) -> Mesh {
        let mut mesh = Mesh {
            origin,
            vertices,
            faces: faces.into(),
            planes: planes.into(),
            home,
            components,
            edges: Arc::default(),
            edge_first: Arc::default(),
            incidences: Arc::default(),
        };
        adjacency::find(&mut mesh);
        mesh
    }

    /// Per face the unit plane (n, −n·p) around `origin`, equal for coplanar neighbours; zero where the face has no area.
    /// They are found when they are first asked for.
    pub fn planes(&self) -> &[DVec4] {
        self.planes.get_or_init(|| planes::unified(self))
    }

    /// The faces at an edge.
    pub fn faces_at(&self, edge: usize) -> &[Incidence] {
        &self.incidences[self.edge_first[edge] as usize..self.edge_first[edge + 1] as usize]
    }

    /// The mesh of some components only. Planes stay those of the whole.
    pub fn of_components(&self, keep: &[bool]) -> Mesh {
        let kept = self.components.iter().zip(keep).filter(|(_, keep)| **keep).map(|(component, _)| component.clone());
        self.taken(kept.collect(), |_| true)
    }

    /// The mesh of some faces only. Planes stay those of the whole; components without a face are left out.
    pub fn of_faces(&self, keep: impl Fn(u32) -> bool) -> Mesh {
        let mut mesh = self.taken(self.components.clone(), keep);
        mesh.components.retain(|component| !component.faces.is_empty());
        mesh
    }

    fn taken(&self, mut components: Vec<Component>, keep: impl Fn(u32) -> bool) -> Mesh {
        let mut kept = Vec::new();
        for component in &mut components {
            let first = kept.len() as u32;
            kept.extend(component.faces.clone().filter(|&face| keep(face)));
            component.faces = first..kept.len() as u32;
        }
        if kept.len() == self.faces.len() {
            return Mesh { components, ..self.clone() };
        }
        let of_kept = |planes: &[DVec4]| kept.iter().map(|&face| planes[face as usize]).collect();
        let planes = if kept.is_empty() { Vec::new() } else { of_kept(self.planes()) };
        let faces = kept.iter().map(|&face| self.faces[face as usize]).collect();
        Mesh::of((self.origin, self.home), Arc::clone(&self.vertices), faces, components, planes.into())
    }

    /// One bit a face: whether its shell, the faces that hang together by edges, has an even number of faces at each of
    /// them, as closed surfaces have whichever way they are wound.
    pub(crate) fn in_even_shells(&self) -> Vec<bool> {
        adjacency::in_even_shells(self)
    }

    /// The corners of a face, metres around `origin`.
    pub fn corners(&self, face: usize) -> [Vec3; 3] {
        self.faces[face].map(|vertex| self.vertices[vertex as usize])
    }

    /// The lowest and highest corner of a box around the faces, in metres of the world frame; none without faces.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        self.bounds_of(0..self.faces.len() as u32)
    }

    /// The same for a run of faces.
    pub(crate) fn bounds_of(&self, run: Range<u32>) -> Option<(DVec3, DVec3)> {
        self.bounds_where(run, |_| true)
    }

    fn bounds_where(&self, run: Range<u32>, counts: impl Fn(u32) -> bool) -> Option<(DVec3, DVec3)> {
        let points = || {
            let vertices = self.faces[run.start as usize..run.end as usize].iter().flatten().copied();
            vertices.filter(|&vertex| counts(vertex)).map(|vertex| self.vertices[vertex as usize])
        };
        let low = points().fold(Vec3::INFINITY, Vec3::min);
        let high = points().fold(Vec3::NEG_INFINITY, Vec3::max);
        (low.x <= high.x).then(|| (low.as_dvec3() + self.origin, high.as_dvec3() + self.origin))
    }

    /// As [`Mesh::bounds`], of what stands together: strays that lie far off are left out.
    pub fn bounds_at_home(&self) -> Option<(DVec3, DVec3)> {
        self.bounds_where(0..self.faces.len() as u32, |vertex| self.is_at_home(vertex)).or_else(|| self.bounds())
    }

    /// The lowest and highest corner of a box around what stands together, metres around `origin`.
    pub fn home(&self) -> [Vec3; 2] {
        self.home
    }

    /// Whether a vertex is one of those that stand together, and no stray that lies far off.
    pub fn is_at_home(&self, vertex: u32) -> bool {
        let [low, high] = self.home;
        let at = self.vertices[vertex as usize];
        at.cmpge(low).all() && at.cmple(high).all()
    }

    /// The height of the highest vertex that a face has, metres of the world frame; −∞ without faces.
    pub fn top(&self) -> f64 {
        self.bounds().map_or(f64::NEG_INFINITY, |(_, high)| high.z)
    }

    /// The homogeneous light (sun: w = 0, lamp: w = 1) of the world frame, as the planes around `origin` see it.
    pub fn local_light(&self, light: DVec4) -> DVec4 {
        light - DVec4::from((self.origin, 0.0)) * light.w
    }

    /// One bit a face: whether the light is on its front side or in its plane.
    ///
    /// Silhouettes, caps and shaders all read this bit, so that volumes are closed whatever the rounding. A face
    /// edge-on to the light, or without area, counts as facing it: its shadow is empty either way.
    pub fn facing(&self, local_light: DVec4) -> Vec<bool> {
        self.planes().iter().map(|&plane| plane_faces(plane, local_light)).collect()
    }
}

/// A welded part, and the component that it becomes once all are welded.
fn of_part(part: Part, origin: DVec3, together: &CornerGroups) -> (Component, WeldedPart) {
    let welded = weld::weld(&part, origin, together);
    let Part { name, aliases, positions, coarse, .. } = part;
    let is_at_home = |run: &CornerPrecision| {
        let corners = &positions[run.corners.start as usize..run.corners.end as usize];
        corners.iter().any(|&corner| together.is_home(corner))
    };
    let at_home = coarse.into_iter().filter(is_at_home);
    let coarse = at_home.max_by(|one, other| one.step_m.total_cmp(&other.step_m));
    let flattened = welded.flattened;
    (Component { name, aliases, faces: 0..0, edges: 0..0, collapsed: [].into(), flattened, coarse }, welded)
}

/// Whether a light is on the front side of a plane or in it: the one place where that is decided.
pub(crate) fn plane_faces(plane: DVec4, local_light: DVec4) -> bool {
    plane.dot(local_light) >= 0.0
}

/// The distance between neighbouring `f32` numbers at the largest coordinate of what stands together, metres; farther off it
/// grows with the distance of the points that are asked about.
struct Spacing {
    home: f32,
}

impl Spacing {
    fn of(mesh: &Mesh) -> Spacing {
        let at_home = (0..mesh.vertices.len() as u32).filter(|&vertex| mesh.is_at_home(vertex));
        let largest = at_home.map(|vertex| mesh.vertices[vertex as usize].abs().max_element());
        Spacing { home: largest.fold(0.0f32, f32::max) }
    }

    fn at(&self, points: &[Vec3]) -> f64 {
        let largest = points.iter().fold(self.home, |largest, point| largest.max(point.abs().max_element()));
        f64::from(largest) * f64::from(f32::EPSILON)
    }
}
