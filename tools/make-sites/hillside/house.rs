//! The house as IFC4, in millimetres: two storeys of walls with openings, windows in them, floors and a roof; and the
//! rooms, which are not solid.

use super::step::{Line, Step, list};
use super::{EASTING, NORTHING, height};

/// Millimetres of a storey, a wall and a floor.
const STOREY: f64 = 3000.0;
const WALL: f64 = 360.0;
const FLOOR: f64 = 250.0;
/// The house, millimetres along its own axes.
const LENGTH: f64 = 16_000.0;
const WIDTH: f64 = 10_000.0;
/// How its own x lies to the map's east, degrees counter-clockwise.
const TURNED_DEG: f64 = 17.0;

/// What all products share.
struct House {
    step: Step,
    owner: Line,
    context: Line,
    up: Line,
    wall: Line,
    glass: Line,
    roof: Line,
}

/// A box: its corner and its size, millimetres.
type Block = ([f64; 3], [f64; 3]);

pub(super) fn ifc() -> String {
    let mut house = House::begin();
    let (project, site, building) = house.places();
    let mut storeys = Vec::new();
    for (number, name) in ["Ground floor", "Upper floor"].into_iter().enumerate() {
        storeys.push(house.storey(name, number as f64 * STOREY));
    }
    let top = 2.0 * STOREY;
    let roof =
        house.product("IFCROOF", "Roof", ([-600.0, -600.0, top], [LENGTH + 1200.0, WIDTH + 1200.0, 300.0]), house.roof);
    house.contain(storeys[1], &[roof]);
    house.aggregate(project, &[site]);
    house.aggregate(site, &[building]);
    house.aggregate(building, &storeys);
    house.step.file("ViewDefinition [ReferenceView_V1.2]")
}

impl House {
    /// Owner, units, contexts and the map.
    fn begin() -> House {
        let mut step = Step::default();
        let person = step.add("IFCPERSON($,'Gnomon',$,$,$,$,$,$)");
        let office = step.add("IFCORGANIZATION($,'Gnomon',$,$,$)");
        let both = step.add(format!("IFCPERSONANDORGANIZATION(#{person},#{office},$)"));
        let application = step.add(format!("IFCAPPLICATION(#{office},'1','make-sites','make-sites')"));
        let owner = step.add(format!("IFCOWNERHISTORY(#{both},#{application},$,.ADDED.,$,$,$,1767225600)"));
        let origin = step.add("IFCCARTESIANPOINT((0.,0.,0.))");
        let axes = step.add(format!("IFCAXIS2PLACEMENT3D(#{origin},$,$)"));
        let context = step.add(format!("IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-05,#{axes},$)"));
        let up = step.add("IFCDIRECTION((0.,0.,1.))");
        let metre = step.add("IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.)");
        let crs =
            step.add(format!("IFCPROJECTEDCRS('EPSG:25833','ETRS89 / UTM zone 33N','ETRS89',$,'UTM','33N',#{metre})"));
        let (sin, cos) = TURNED_DEG.to_radians().sin_cos();
        let on_ground = height(0.0, 0.0);
        step.add(format!(
            "IFCMAPCONVERSION(#{context},#{crs},{EASTING:.4},{NORTHING:.4},{on_ground:.3},{cos:.9},{sin:.9},0.001)"
        ));
        let mut style = |name: &str, [red, green, blue]: [f64; 3], transparency: f64| {
            let colour = step.add(format!("IFCCOLOURRGB($,{red:.2},{green:.2},{blue:.2})"));
            let shading = step.add(format!("IFCSURFACESTYLESHADING(#{colour},{transparency:.2})"));
            step.add(format!("IFCSURFACESTYLE('{name}',.BOTH.,(#{shading}))"))
        };
        let wall = style("Render", [0.9, 0.88, 0.82], 0.0);
        let glass = style("Glass", [0.6, 0.75, 0.85], 0.6);
        let roof = style("Gravel", [0.6, 0.6, 0.58], 0.0);
        House { step, owner, context, up, wall, glass, roof }
    }

    /// Project, site and building.
    fn places(&mut self) -> (Line, Line, Line) {
        let metre = self.step.add("IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.)");
        let angle = self.step.add("IFCSIUNIT(*,.PLANEANGLEUNIT.,$,.RADIAN.)");
        let area = self.step.add("IFCSIUNIT(*,.AREAUNIT.,$,.SQUARE_METRE.)");
        let units = self.step.add(format!("IFCUNITASSIGNMENT((#{metre},#{angle},#{area}))"));
        let (owner, context) = (self.owner, self.context);
        let guid = self.step.guid();
        let project =
            self.step.add(format!("IFCPROJECT({guid},#{owner},'House on a slope',$,$,$,$,(#{context}),#{units})"));
        let placement = self.placement([0.0; 3]);
        let guid = self.step.guid();
        let site = self.step.add(format!(
            "IFCSITE({guid},#{owner},'Plot',$,$,#{placement},$,$,.ELEMENT.,(47,48,0,0),(13,2,24,0),{:.3},$,$)",
            1000.0 * height(0.0, 0.0)
        ));
        let guid = self.step.guid();
        let building =
            self.step.add(format!("IFCBUILDING({guid},#{owner},'House',$,$,#{placement},$,$,.ELEMENT.,$,$,$)"));
        (project, site, building)
    }

    fn placement(&mut self, at: [f64; 3]) -> Line {
        let [x, y, z] = at;
        let point = self.step.add(format!("IFCCARTESIANPOINT(({x:.1},{y:.1},{z:.1}))"));
        let axes = self.step.add(format!("IFCAXIS2PLACEMENT3D(#{point},$,$)"));
        self.step.add(format!("IFCLOCALPLACEMENT($,#{axes})"))
    }

    /// A storey: four walls with windows, a floor, and its room.
    fn storey(&mut self, name: &str, level: f64) -> Line {
        let owner = self.owner;
        let placement = self.placement([0.0; 3]);
        let guid = self.step.guid();
        let storey = self
            .step
            .add(format!("IFCBUILDINGSTOREY({guid},#{owner},'{name}',$,$,#{placement},$,$,.ELEMENT.,{level:.1})"));
        let wall_height = STOREY - FLOOR;
        let foot = level + FLOOR;
        let mut products =
            vec![self.product("IFCSLAB", "Floor", ([0.0, 0.0, level], [LENGTH, WIDTH, FLOOR]), self.wall)];
        let south: Vec<Block> =
            (0..4).map(|at| self::window([1200.0 + 3600.0 * f64::from(at), 0.0, foot], true)).collect();
        let north: Vec<Block> =
            (0..3).map(|at| self::window([2000.0 + 4800.0 * f64::from(at), WIDTH - WALL, foot], true)).collect();
        let west = vec![self::window([0.0, 3600.0, foot], false)];
        let east = vec![
            self::window([LENGTH - WALL, 2000.0, foot], false),
            self::window([LENGTH - WALL, 5600.0, foot], false),
        ];
        let walls: [(&str, Block, Vec<Block>); 4] = [
            ("South wall", ([0.0, 0.0, foot], [LENGTH, WALL, wall_height]), south),
            ("North wall", ([0.0, WIDTH - WALL, foot], [LENGTH, WALL, wall_height]), north),
            ("West wall", ([0.0, WALL, foot], [WALL, WIDTH - 2.0 * WALL, wall_height]), west),
            ("East wall", ([LENGTH - WALL, WALL, foot], [WALL, WIDTH - 2.0 * WALL, wall_height]), east),
        ];
        for (name, block, windows) in walls {
            let wall = self.product("IFCWALL", name, block, self.wall);
            products.push(wall);
            for (number, window) in (1..).zip(windows) {
                products.push(self.window(wall, &format!("{name}, window {number}"), window));
            }
        }
        self.contain(storey, &products);
        let inside = ([WALL, WALL, foot], [LENGTH - 2.0 * WALL, WIDTH - 2.0 * WALL, wall_height]);
        let shape = self.shape(inside, None);
        let placement = self.placement([0.0; 3]);
        let guid = self.step.guid();
        let room = self
            .step
            .add(format!("IFCSPACE({guid},#{owner},'Room',$,$,#{placement},#{shape},$,.ELEMENT.,.INTERNAL.,$)"));
        self.aggregate(storey, &[room]);
        storey
    }

    /// An opening in a wall, and the pane that fills it.
    fn window(&mut self, wall: Line, name: &str, opening: Block) -> Line {
        let owner = self.owner;
        let (corner, size) = opening;
        // the opening goes through the wall, the pane stands in its middle
        let across = usize::from(size[0] > size[1]);
        let (mut hole, mut pane) = ((corner, size), (corner, size));
        hole.0[across] -= 100.0;
        hole.1[across] += 200.0;
        pane.0[across] += WALL / 2.0 - 30.0;
        pane.1[across] = 60.0;
        let placement = self.placement([0.0; 3]);
        let shape = self.shape(hole, None);
        let guid = self.step.guid();
        let hole = self
            .step
            .add(format!("IFCOPENINGELEMENT({guid},#{owner},'Opening',$,$,#{placement},#{shape},$,.OPENING.)"));
        let guid = self.step.guid();
        self.step.add(format!("IFCRELVOIDSELEMENT({guid},#{owner},$,$,#{wall},#{hole})"));
        let window = self.product("IFCWINDOW", name, pane, self.glass);
        let guid = self.step.guid();
        self.step.add(format!("IFCRELFILLSELEMENT({guid},#{owner},$,$,#{hole},#{window})"));
        window
    }

    /// A product that is a box.
    fn product(&mut self, kind: &str, name: &str, block: Block, style: Line) -> Line {
        let owner = self.owner;
        let placement = self.placement([0.0; 3]);
        let shape = self.shape(block, Some(style));
        let guid = self.step.guid();
        let rest = if kind == "IFCWINDOW" { ",$,$,$,$,$" } else { ",$" };
        self.step.add(format!("{kind}({guid},#{owner},'{name}',$,$,#{placement},#{shape},${rest})"))
    }

    /// A box as an extruded rectangle.
    fn shape(&mut self, ([x, y, z], [length, width, height]): Block, style: Option<Line>) -> Line {
        let middle = self.step.add(format!("IFCCARTESIANPOINT(({:.1},{:.1}))", x + length / 2.0, y + width / 2.0));
        let axes = self.step.add(format!("IFCAXIS2PLACEMENT2D(#{middle},$)"));
        let profile = self.step.add(format!("IFCRECTANGLEPROFILEDEF(.AREA.,$,#{axes},{length:.1},{width:.1})"));
        let foot = self.step.add(format!("IFCCARTESIANPOINT((0.,0.,{z:.1}))"));
        let axes = self.step.add(format!("IFCAXIS2PLACEMENT3D(#{foot},$,$)"));
        let up = self.up;
        let solid = self.step.add(format!("IFCEXTRUDEDAREASOLID(#{profile},#{axes},#{up},{height:.1})"));
        if let Some(style) = style {
            self.step.add(format!("IFCSTYLEDITEM(#{solid},(#{style}),$)"));
        }
        let context = self.context;
        let body = self.step.add(format!("IFCSHAPEREPRESENTATION(#{context},'Body','SweptSolid',(#{solid}))"));
        self.step.add(format!("IFCPRODUCTDEFINITIONSHAPE($,$,(#{body}))"))
    }

    fn contain(&mut self, storey: Line, products: &[Line]) {
        let (owner, guid) = (self.owner, self.step.guid());
        self.step.add(format!("IFCRELCONTAINEDINSPATIALSTRUCTURE({guid},#{owner},$,$,{},#{storey})", list(products)));
    }

    fn aggregate(&mut self, whole: Line, parts: &[Line]) {
        let (owner, guid) = (self.owner, self.step.guid());
        self.step.add(format!("IFCRELAGGREGATES({guid},#{owner},$,$,#{whole},{})", list(parts)));
    }
}

/// A window's opening in a wall that runs along the house, or across it: its foot is a metre above the floor.
fn window([x, y, foot]: [f64; 3], is_along: bool) -> Block {
    let size = if is_along { [2000.0, WALL, 1500.0] } else { [WALL, 2000.0, 1500.0] };
    ([x, y, foot + 900.0], size)
}
