# Scenes: everything a world starts from, and what may be spawned into one.
#
# The binary form of a scene file is a `Scene`; its JSON form uses the same names and the same
# nesting (a group is an object). Bodies and joints are also what a `Spawn` command carries.
#
# Fields grow only at the end: a number once given keeps its meaning for good. A default is the
# value of a field that an older writer did not know, and equals the default in core/scene/scene.h.
# Units and ranges are said here for readers; core's `check` is what refuses a value out of range.
# Groups instead of structs hold pairs such as a position, so that they cost no pointer.

@0xb43dcf3b1fa4a1a0;

using Cxx = import "/capnp/c++.capnp";
$Cxx.namespace("huestep::schema");

struct Vec2 {
  # A point of a polygon, m, in the frame of the body's origin.
  x @0 :Float32;
  y @1 :Float32;
}

enum ShapeKind {
  circle @0;   # 1 vertex
  capsule @1;  # 2 vertices
  polygon @2;  # 3 to 8 vertices, convex, counter-clockwise
  segment @3;  # 2 vertices, radius 0, no mass
  chainSegment @4;  # ghost, 2 vertices, ghost: one side of a segment and its neighbours in a chain
}

struct Shape {
  # The set of points within `radius` of the convex hull of `vertices`.
  kind @0 :ShapeKind;
  vertices @1 :List(Vec2);            # m, 1 to 8
  radius @2 :Float32 = 0.5;           # m, [0, 10000]
  density @3 :Float32 = 1;            # kg/m2, [0, 1e6]
  material :group {
    friction @4 :Float32 = 0.6;       # Coulomb's coefficient, [0, 100]
    restitution @5 :Float32;          # Newton's coefficient, [0, 1]
    rollingResistance @6 :Float32;    # [0, 100]
    tangentSpeed @7 :Float32;         # m/s, of a conveyor belt's surface
  }
  filter :group {
    category @8 :UInt32 = 1;
    mask @9 :UInt32 = 0xffffffff;
    group @10 :Int32;                 # equal and not 0: always touch if > 0, never if < 0
  }
}

enum BodyType {
  static @0;
  kinematic @1;
  dynamic @2;
}

struct Body {
  id @0 :UInt32;                      # 0: the next free one; must be 0 in a spawn
  type @1 :BodyType;
  fixedRotation @2 :Bool;
  maySleep @3 :Bool = true;
  asleep @4 :Bool;                    # starts asleep; for dynamic bodies
  position :group {                   # m, of the body's origin
    x @5 :Float32;
    y @6 :Float32;
  }
  rotation :group {                   # unit vector (cos, sin)
    c @7 :Float32 = 1;
    s @8 :Float32;
  }
  velocity :group {                   # m/s, of the centre of mass
    x @9 :Float32;
    y @10 :Float32;
  }
  angularVelocity @11 :Float32;       # rad/s
  linearDamping @12 :Float32;         # 1/s, [0, 1000]
  angularDamping @13 :Float32;        # 1/s, [0, 1000]
  gravityScale @14 :Float32 = 1;      # within 1000 of 0
  shapes @15 :List(Shape);            # at most 1024
  firstShape @16 :UInt32;             # with an id: the first id of its shapes; 0: the next ones
}

enum JointKind {
  revolute @0;  # two bodies share a point
  distance @1;  # two points keep a distance, or a range of it
  mouse @2;     # a point of body B is drawn to `target` with a bounded force
  weld @3;      # two bodies share a point and an angle
  prismatic @4; # a point of body B slides along `axis`, neither body turns against the other
}

enum Method {
  softStep @0;    # coloured Gauss-Seidel with soft rows and substeps: the product
  sequential @1;  # the same in key order, one constraint after another
  jacobi @2;      # the same with all constraints of a sweep side by side
  jacobiSplit @3; # likewise, each with its share of its bodies' mass
  pgs @4;         # projected Gauss-Seidel over one step, errors in the velocity rows
  pgsNgs @5;      # the same without errors in velocities; sweeps over positions follow
  locks @6;       # the soft step, constraints to all threads in key order, a lock a body
  atomics @7;     # likewise, with atomic additions to bodies instead of locks
  avbd @8;        # augmented vertex block descent: positions body by body, backward Euler
  direct @9;      # joint trees at once, all else as in softStep
}

struct Joint {
  # Between two bodies of the same list, given by their places in it.
  id @0 :UInt32;
  kind @1 :JointKind;
  collideConnected @2 :Bool;
  bodyA @3 :UInt32;
  bodyB @4 :UInt32;
  anchorA :group {                    # m, in the frame of body A's origin
    x @5 :Float32;
    y @6 :Float32;
  }
  anchorB :group {                    # m, in the frame of body B's origin
    x @7 :Float32;
    y @8 :Float32;
  }
  reference :group {                  # rotation of B relative to A: revolute: at coordinate 0;
                                      # weld, prismatic: the one that is held
    c @9 :Float32 = 1;
    s @10 :Float32;
  }
  length @11 :Float32 = 1;            # distance: rest length, m
  target :group {                     # mouse: m, in the world
    x @12 :Float32;
    y @13 :Float32;
  }
  maxForce @14 :Float32;              # mouse: N
  spring :group {
    enabled @15 :Bool;
    hertz @16 :Float32;               # Hz, [0, 1000]
    dampingRatio @17 :Float32;        # 1 is critical
  }
  limit :group {
    enabled @18 :Bool;
    lower @19 :Float32;               # rad, or m for a distance or prismatic joint
    upper @20 :Float32;
  }
  motor :group {
    enabled @21 :Bool;
    speed @22 :Float32;               # rad/s or m/s
    maxEffort @23 :Float32;           # N m or N
  }
  axis :group {                       # prismatic: its direction in the frame of body A, unit vector
    c @24 :Float32 = 1;
    s @25 :Float32;
  }
}

struct Players {
  # What players get when they join a session, and what they may do there.
  body @0 :Body;                      # null: players have no body
  spawnPoints @1 :List(Vec2);         # m; player k gets point k mod size; at most 4096
  maxSpawned @2 :UInt32 = 16;         # bodies a player may have spawned at a time
  maxImpulse @3 :Float32 = 100;       # N s a command
  maxForce @4 :Float32 = 1000;        # N a command or a grab
}

struct Rules {
  # Which game is played, and with what (core/rules/rules.h).
  struct Parameter {
    name @0 :Text;                    # 1 to 32 of [a-zA-Z0-9_-]
    value @1 :Float32;
  }
  name @0 :Text;                      # 1 to 32 of [a-z0-9_-]
  version @1 :UInt32 = 1;             # of the rules: other versions play other games
  seed @2 :UInt32;                    # of their dice
  parameters @3 :List(Parameter);     # at most 64, names rise
}

struct Scene {
  version @0 :UInt32;                 # of this layout: 1
  name @1 :Text;                      # for people, at most 256 bytes
  gravity :group {                    # m/s2
    x @2 :Float32;
    y @3 :Float32 = -10;
  }
  stepSeconds @4 :Float32 = 0.016666668;  # s, length of one tick, [0.0001, 0.1]
  substeps @5 :UInt32 = 4;            # of a tick, [1, 64]; 0: planned by need
  sleep @6 :Bool = true;              # whether islands at rest fall asleep
  bodies @7 :List(Body);
  joints @8 :List(Joint);
  players @9 :Players;                # null: players may only watch
  limits :group {                     # caps of the world; a command that would pass one is rejected
    bodies @10 :UInt32 = 100000;
    shapes @11 :UInt32 = 200000;
    joints @12 :UInt32 = 100000;
    commandsPerTick @13 :UInt32 = 1024;
    players @14 :UInt32 = 1024;
  }
  counters :group {                   # where the id counters of a new world start
    nextBody @15 :UInt32 = 1;
    nextShape @16 :UInt32 = 1;
    nextJoint @17 :UInt32 = 1;
  }
  method @18 :Method = softStep;      # how constraints are solved
  need :group {                       # how far the world may be off at rest; 0: visual
    penetration @19 :Float32;         # m
    joint @20 :Float32;               # m
  }
  rules @21 :Rules;                   # null: no game's; the world alone
}
