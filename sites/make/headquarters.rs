pub(super) fn model() -> super::glb::Model { super::tower::model() }
