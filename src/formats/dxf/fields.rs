//! The groups of one entity in a DXF file.

use super::group::{DxfGroup, DxfGroups, cut_off};
use crate::message::Message;
use glam::DVec3;

/// The groups of an entity, without those that programs add for their own use.
pub(super) struct DxfFields<'a> {
    pub groups: Vec<DxfGroup<'a>>,
}

impl<'a> DxfFields<'a> {
    /// Reads the groups up to the next entity, and the first group of that.
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

    /// A number, if the entity has it.
    pub(super) fn given(&self, code: i32) -> Option<f64> {
        self.first(code).and_then(DxfGroup::real)
    }

    /// A number; 0 if the entity does not have it.
    pub(super) fn real(&self, code: i32) -> f64 {
        self.given(code).unwrap_or(0.0)
    }

    /// A whole number; 0 if the entity does not have it.
    pub(super) fn whole(&self, code: i32) -> i64 {
        self.first(code).and_then(DxfGroup::whole).unwrap_or(0)
    }

    /// A name; empty if the entity does not have it.
    pub(super) fn name(&self, code: i32) -> String {
        self.first(code).map(DxfGroup::name).unwrap_or_default()
    }

    /// A point. The codes of its y and z are higher by 10 and 20.
    pub(super) fn point(&self, code: i32) -> DVec3 {
        DVec3::new(self.real(code), self.real(code + 10), self.real(code + 20))
    }

    /// The normal of the plane of the entity.
    pub(super) fn extrusion(&self) -> DVec3 {
        match self.first(210) {
            Some(_) => self.point(210),
            None => DVec3::Z,
        }
    }
}
