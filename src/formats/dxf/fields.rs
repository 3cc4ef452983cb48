//! One entity of a DXF file: its groups, up to the next entity.

use super::group::{DxfGroup, DxfGroups, cut_off};
use crate::message::Message;
use glam::DVec3;

/// The groups of an entity, without those that programs add for themselves.
pub(super) struct DxfFields<'a> {
    pub groups: Vec<DxfGroup<'a>>,
}

impl<'a> DxfFields<'a> {
    /// The groups up to the next entity, and what that begins with.
    pub(super) fn read(groups: &mut DxfGroups<'a>) -> Result<(Self, DxfGroup<'a>), Message> {
        let (mut fields, mut is_own) = (Vec::new(), true);
        while let Some(group) = groups.next()? {
            match group.code {
                0 => return Ok((Self { groups: fields }, group)),
                // an object within the object
                101 => is_own = false,
                1000.. | 999 => (),
                _ if is_own => fields.push(group),
                _ => (),
            }
        }
        Err(cut_off(groups))
    }

    fn first(&self, code: i32) -> Option<&DxfGroup<'a>> {
        self.groups.iter().find(|group| group.code == code)
    }

    /// A number, where the entity has it.
    pub(super) fn given(&self, code: i32) -> Option<f64> {
        self.first(code).and_then(DxfGroup::real)
    }

    /// A number; 0 where the entity has it not.
    pub(super) fn real(&self, code: i32) -> f64 {
        self.given(code).unwrap_or(0.0)
    }

    /// A whole number; 0 where the entity has it not.
    pub(super) fn whole(&self, code: i32) -> i64 {
        self.first(code).and_then(DxfGroup::whole).unwrap_or(0)
    }

    /// A name; empty where the entity has none.
    pub(super) fn name(&self, code: i32) -> String {
        self.first(code).map(DxfGroup::name).unwrap_or_default()
    }

    /// A point, whose y and z have the codes 10 and 20 farther on.
    pub(super) fn point(&self, code: i32) -> DVec3 {
        DVec3::new(self.real(code), self.real(code + 10), self.real(code + 20))
    }

    /// The normal of the plane that it is drawn in.
    pub(super) fn extrusion(&self) -> DVec3 {
        match self.first(210) {
            Some(_) => self.point(210),
            None => DVec3::Z,
        }
    }
}
