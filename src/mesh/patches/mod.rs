//! Flat patches: components' faces as receivers, each patch with a raster of texels in its own plane.
//!
//! A patch is a set of faces of one component that are connected by edges and lie in one plane, within `FLAT_ANGLE_DEG`
//! and [`FLAT_M`]. So holes stay holes, and every face with an area is in exactly one patch. Curved bodies become many
//! small patches. A texel is judged at its centre, if that lies in one of the patch's faces; a patch too thin to
//! contain a centre is judged at one point in its largest face. All patches are packed into the pages of an atlas, for
//! the graphics adapter and for textures in files.

mod frame;
mod gather;
mod pack;
mod patch;
mod seen_side;
mod shared;
mod texels;

pub use patch::{
    DEFAULT_CELL_M, FLAT_ANGLE_DEG, FLAT_M, GUTTER, MOST_PAGE, MOST_TEXELS, Patch, Patches, Texel, UncountedArea,
};

use super::Mesh;

impl Patches {
    /// Gathers the faces of the components that receive, with texels of `cell` metres. The texels are larger if the
    /// atlas would otherwise have more than `most_texels`, or a patch be longer than a page.
    pub fn of(mesh: &Mesh, receives: &[bool], cell: f64, most_texels: usize) -> Patches {
        let flats = gather::gather(mesh, receives);
        let frames: Vec<_> = frame::of_all(mesh, &flats, cell);
        let (fitting, page_size) = pack::fitting_cell(&frames, cell, most_texels);
        let mut patches = Patches {
            origin: mesh.origin,
            cell: fitting,
            asked_cell: cell,
            list: Vec::with_capacity(flats.len()),
            faces: Vec::new(),
            texels: Vec::new(),
            page_size,
            pages: 0,
            left_out: UncountedArea::default(),
        };
        for (flat, frame) in flats.iter().zip(&frames) {
            let first = patches.faces.len() as u32;
            patches.faces.extend(&flat.faces);
            let [width, height] = frame.texels(fitting);
            patches.list.push(Patch {
                component: flat.component,
                faces: first..patches.faces.len() as u32,
                plane: flat.plane,
                two_sided: flat.two_sided,
                area_m2: flat.area_m2,
                uncounted: Vec::new(),
                corner: frame.corner(fitting),
                right: frame.right,
                down: frame.down,
                width,
                height,
                page: 0,
                x: 0,
                y: 0,
                texels: 0..0,
                alone: None,
            });
        }
        pack::place(&mut patches);
        texels::find(mesh, &mut patches);
        patches
    }
}
