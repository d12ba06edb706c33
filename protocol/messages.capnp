# The messages between server, clients and viewers.
#
# Each message is the root struct of its own type; which type it is stands in the frame's header
# (protocol/frame.h), so no union is wrapped around them. On the wire a message is exactly one flat
# segment without a segment table, never packed. Limits are said beside each field and enforced in
# protocol/codec.cpp; most bytes of a message by type stand in protocol/codec.h.
#
# Fields grow only at the end: a number once given keeps its type and meaning for good, and a
# message of the version before must decode to the same value (tests/protocol/corpus).
# Texts are UTF-8 without control characters, so that they may be logged as they are. Floats are
# finite. "Tick" counts the steps taken since the session began: state T is the world after T steps,
# frame T leads from state T to state T + 1.

@0xbc2aab5c72211d7e;

using Cxx = import "/capnp/c++.capnp";
using Scene = import "scene.capnp";
$Cxx.namespace("huestep::schema");

enum Role {
  player @0;     # steps the world and may send intents
  spectator @1;  # steps the world or watches; sends no intents
}

struct Hello {
  # Client to server, the first message of a connection. At most 1 KiB: whoever sends it is unknown.
  version @0 :UInt32;                 # of the protocol
  fingerprint :group {                # what two builds must share to step the same bits
    selfTest @1 :UInt64;              # full root of the self-test scene after 120 ticks
    schema @2 :UInt64;                # hash of the text of these schemas, prose aside
    scene @3 :UInt32;                 # version of the scene layout
  }
  session @4 :Text;                   # 1 to 64 of [a-z0-9_-]
  role @5 :Role;
  resume @6 :Data;                    # empty, or the 16 bytes of the token of an earlier Welcome
  haveTick @7 :UInt64;                # with resume: last tick the client holds a world of, or 0
  haveHash @8 :UInt64;                # motion root of that world
  ticket @9 :Data;                    # empty, or a sealed ticket (protocol/ticket.h), <= 256 bytes
  rules @10 :List(UInt64);            # XXH3-64 of the name, a space and the version of each game's
                                      # rules that the build has; at most 48
}

struct Welcome {
  # Server to client, the answer to a Hello that may play. A snapshot or the tail follows.
  session @0 :Text;                   # as in Hello
  player @1 :UInt32;                  # 0 for a spectator
  epoch @2 :UInt32;                   # counts the server's starts of this session
  tick @3 :UInt64;                    # the next tick the server will close
  ticksPerSecond @4 :Float32;         # 1/s, (0, 10000]
  inputDelay @5 :UInt32;              # ticks from an intent's arrival to its earliest tick, <= 600;
                                      # for who predicts: from an input to the tick it asks for
  maxCommandsPerIntent @6 :UInt32;    # [1, 64]
  lastSequence @7 :UInt64;            # of this player, as far as the server has put in order
  resume @8 :Data;                    # 16 bytes: takes the seat up again after a lost connection
  maxQueuedCommands @9 :UInt32 = 256; # [1, 65536]: of this player, waiting for their tick; one more
                                      # ends the connection with TooFast
  maxQueuedBytes @10 :UInt32 = 65536; # [16384, 16777216]: the same in bytes as commands take in an
                                      # Intent
  maxInputDelay @11 :UInt32;          # <= 600: who predicts adapts its delay between inputDelay and
                                      # this to its round trip; not above inputDelay: it is fixed
}

struct Spawn {
  # Adds bodies and joints between them. At most 1024 of each; a player's spawn is held to less by
  # the world itself, which rejects it the same way everywhere.
  bodies @0 :List(Scene.Body);
  joints @1 :List(Scene.Joint);
}

struct Command {
  # One action of one author. Bodies and joints by id. 48 bytes, and a spawn's bodies beside it.
  author @0 :UInt32;                  # 0: the host. In an Intent the server sets it.
  sequence @1 :UInt64;                # counts the author's commands from 1
  action :union {
    addPlayer :group {                # host only
      player @2 :UInt32;
    }
    removePlayer :group {             # host only
      player @3 :UInt32;
    }
    applyImpulse :group {
      body @4 :UInt32;
      impulse :group {                # N s
        x @5 :Float32;
        y @6 :Float32;
      }
      point :group {                  # m, in the world
        x @7 :Float32;
        y @8 :Float32;
      }
    }
    applyForce :group {               # for this tick
      body @9 :UInt32;
      force :group {                  # N
        x @10 :Float32;
        y @11 :Float32;
      }
      point :group {                  # m, in the world
        x @12 :Float32;
        y @13 :Float32;
      }
    }
    grab :group {
      body @14 :UInt32;
      point :group {                  # m, in the world, where the body is taken
        x @15 :Float32;
        y @16 :Float32;
      }
      target :group {                 # m, in the world
        x @17 :Float32;
        y @18 :Float32;
      }
    }
    moveGrab :group {
      target :group {                 # m, in the world
        x @19 :Float32;
        y @20 :Float32;
      }
    }
    release @21 :Void;
    spawn @22 :Spawn;
    removeBody :group {
      body @23 :UInt32;
    }
    removeJoint :group {              # host only
      joint @24 :UInt32;
    }
    setMotor :group {
      joint @25 :UInt32;
      enabled @26 :Bool;
      speed @27 :Float32;             # rad/s or m/s
    }
    setVelocity :group {              # of a kinematic body; host only
      body @28 :UInt32;
      velocity :group {               # m/s
        x @29 :Float32;
        y @30 :Float32;
      }
      angularVelocity @31 :Float32;   # rad/s
    }
    setTarget :group {                # where a kinematic body is after this tick; host only
      body @32 :UInt32;
      position :group {               # m, of the body's origin, in the world
        x @33 :Float32;
        y @34 :Float32;
      }
      rotation :group {               # cosine and sine of its angle
        c @35 :Float32;
        s @36 :Float32;
      }
    }
    custom :group {                   # what the rules of the session's game make of it
      kind @37 :UInt32;               # which of the rules' actions
      id @38 :UInt32;
      number @39 :Int32;
      vector :group {
        x @40 :Float32;
        y @41 :Float32;
      }
    }
  }
}

struct Intent {
  # Client to server, at any time after Welcome: what the player wants, and what its world was.
  commands @0 :List(Command);         # at most 64; sequences rise
  checkpoint :union {                 # the newest world the client has stepped to
    none @1 :Void;
    some :group {
      tick @2 :UInt64;
      motionRoot @3 :UInt64;
    }
  }
  tick @4 :UInt64;                    # of all its commands: the first frame that may have them; if
                                      # that is closed, the next. 0: inputDelay after their arrival
}

struct Frame {
  # Server to client, one a tick: everything that decides one step. Also the record of the journal.
  tick @0 :UInt64;                    # leads from `tick` to `tick + 1` steps taken
  commands @1 :List(Command);         # in key order, at most 4096
  substituted @2 :List(UInt32);       # players whose input came too late, at most 4096: nothing is
                                      # heard of them, or commands here asked for a frame before
  previousRoot @3 :UInt64;            # motion root of the world this frame is applied to
  committed @4 :UInt64;               # frames below this tick are on disk
}

struct SnapshotBegin {
  # Server to client: a snapshot of the session follows in chunks.
  tick @0 :UInt64;
  bytes @1 :UInt64;                   # at most 256 MiB
  hash @2 :UInt64;                    # XXH3-64 of all bytes
}

struct SnapshotChunk {
  # Server to client: a piece of the snapshot begun last.
  offset @0 :UInt64;
  data @1 :Data;                      # at most 60,000 bytes
}

struct SnapshotEnd {
  # Server to client: all chunks have been sent; frames go on from `tick`.
  tick @0 :UInt64;
}

struct SnapshotRequest {
  # Client to server: my world after `tick` differs, or I have none: send a snapshot.
  tick @0 :UInt64;
}

struct HashQuery {
  # Either way: what is the hash of each block of 64 bodies after this tick?
  tick @0 :UInt64;
}

struct HashNodes {
  # The answer to a HashQuery; no leaves if the peer no longer has that tick.
  tick @0 :UInt64;
  leaves @1 :List(UInt64);            # at most 4096 a message
  first @2 :UInt32;                   # place of the first of them
}

struct DesyncReport {
  # Client to server: what a client found when its world differed, for the log and its operators.
  tick @0 :UInt64;
  mine @1 :UInt64;                    # the client's motion root
  yours @2 :UInt64;                   # the server's
  body @3 :UInt32;                    # the body, or 0
  field @4 :Text;                     # "velocity.x", at most 128 bytes
  here @5 :Text;                      # the client's value, at most 128 bytes
  there @6 :Text;                     # the server's, at most 128 bytes
}

struct Ping {
  # Either way; the answer is the same with `reply` set.
  nonce @0 :UInt64;
  reply @1 :Bool;
  tick @2 :UInt64;                    # a server's reply: the tick it will close next when the Ping
                                      # came, or 0
  sinceClose @3 :UInt32;              # us, with tick: since it closed the one before
}

struct Bye {
  # Either way: the connection ends.
  reason @0 :UInt16;                  # ByeReason of protocol/messages.h
  text @1 :Text;                      # a sentence for a person, at most 256 bytes
  mayResume @2 :Bool;                 # the resume token still holds
}

struct View {
  # Server to viewer: what to draw after a tick. Viewers do not step. Numbers stand in flat lists,
  # so that a viewer in a browser can lay an array over them.
  struct Shape {
    body @0 :UInt32;                  # place in `poses`
    radius @1 :Float32;               # m
    kind @2 :Scene.ShapeKind;
    vertexCount @3 :UInt8;            # how many of `vertices` are its own, 1 to 8
  }
  struct Contact {
    x @0 :Float32;                    # m, in the world
    y @1 :Float32;
    colour @2 :UInt8;                 # graph colour; 255: overflow
  }
  tick @0 :UInt64;
  root @1 :UInt64;                    # motion root
  players @2 :UInt32;
  definitions @3 :UInt32;             # rises when shapes changed; shapes are sent only then
  poses @4 :List(Float32);            # x, y, cos, sin of each body's centre of mass; <= 131,072
  flags @5 :Data;                     # a byte a body: bit 0 asleep, bits 1-2 type, bit 3 a player's
  contacts @6 :List(Contact);         # at most 262,144
  bodies @7 :List(UInt32);            # with shapes: the id of each body
  shapes @8 :List(Shape);             # at most 262,144
  vertices @9 :List(Float32);         # x, y of the shapes' vertices, in the centre-of-mass frame
  joints @10 :List(Float32);          # x, y, x, y: the two ends of each, m, in the world; <= 131,072
  score @11 :Text;                    # how the game stands, for people, at most 128 bytes
}
