/**
 * Reads a frame of the protocol that holds a View.
 *
 * A hand-written reader of one message, instead of a Cap'n Proto library: it lays typed arrays over
 * the bytes that came and copies nothing, so a frame of 1,000 bodies costs microseconds where a
 * library's accessors cost milliseconds. tests/browser/view_test.mjs compares it, field by field,
 * with Cap'n Proto's own decoder, and feeds it damaged frames.
 *
 * The frame (protocol/frame.h): 16 bytes of header, then one flat segment, not packed:
 *
 *   0  u16 magic 0x4875   2  u8 version 1   3  u8 type 13 (View)   4  u32 payload bytes   8  u64
 *
 * The checksum at 8 guards journals and streams; here TCP and the WebSocket's own lengths do.
 *
 * The payload (protocol/messages.capnp, struct View). Word 0 points to the root struct:
 *
 *   data bytes   0 tick u64   8 root u64   16 players u32   20 definitions u32
 *   pointers     0 poses f32[4n]   1 flags u8[n]   2 contacts {x f32, y f32, colour u8}[]
 *                3 bodies u32[n]   4 shapes {body u32, radius f32, kind u16, vertexCount u8}[]
 *                5 vertices f32[]   6 joints f32[4m]   7 score, UTF-8 with a zero behind it
 *
 * Little-endian, as the bytes are and every browser is. Every pointer is checked against the
 * segment before anything is read through it, and every number that indexes before it is used.
 */

export const headerBytes = 16;
const magic = 0x4875;
const protocolVersion = 1;
const viewType = 13;

/** Element sizes of lists, as Cap'n Proto numbers them. */
const oneByte = 2;
const fourBytes = 4;
const composite = 7;

/** A frame that is not what it should be. Says what is wrong with it. */
export class ViewError extends Error {}

/** @param {boolean} condition @param {string} sentence */
function need(condition, sentence) {
  if (!condition) throw new ViewError(sentence);
}

/**
 * @typedef {object} Shapes
 * @property {number} count
 * @property {Uint32Array} body place in `poses`, of each shape
 * @property {Float32Array} radius m
 * @property {Uint8Array} kind 0 circle, 1 capsule, 2 polygon, 3 segment
 * @property {Uint32Array} first place of its first vertex; one more entry than shapes
 * @property {Float32Array} vertices x, y, in the frame of the body's centre of mass
 */
/**
 * @typedef {object} Contacts
 * @property {number} count
 * @property {number} stride floats from one to the next
 * @property {Float32Array} floats x and y at `stride * i` and `stride * i + 1`
 * @property {Uint8Array} bytes colour at `4 * stride * i + 8`
 */
/**
 * @typedef {object} View
 * @property {number} tick
 * @property {string} root 16 hexadecimal digits
 * @property {number} players
 * @property {number} definitions
 * @property {number} bodies how many
 * @property {Float32Array} poses x, y, cos, sin of each
 * @property {Uint8Array} flags bit 0 asleep, bits 1-2 type (static, kinematic, dynamic),
 *   bit 3 a player's
 * @property {Contacts} contacts
 * @property {Float32Array} joints x, y, x, y: the ends of each, in the world
 * @property {string} score how the game stands; empty where none is played
 * @property {Shapes | null} shapes only when the definitions changed
 */

/** Bounds-checked pointers of one segment. */
class Segment {
  /** @param {ArrayBuffer} buffer @param {number} start @param {number} words */
  constructor(buffer, start, words) {
    this.buffer = buffer;
    this.start = start;
    this.words = words;
    this.data = new DataView(buffer, start, 8 * words);
  }

  /** A struct pointer. @param {number} word where it stands @param {string} name */
  struct(word, name) {
    const low = this.data.getInt32(8 * word, true);
    need((low & 3) === 0, `${name}: not a struct`);
    const at = word + 1 + (low >> 2);
    const dataWords = this.data.getUint16(8 * word + 4, true);
    const pointers = this.data.getUint16(8 * word + 6, true);
    need(at >= 0 && at + dataWords + pointers <= this.words, `${name}: outside the message`);
    return { at, dataWords, pointers };
  }

  /**
   * A list pointer; a null one is an empty list.
   * @param {{at: number, dataWords: number, pointers: number}} owner
   * @param {number} index of the pointer in its struct
   * @param {number} size of the elements
   * @param {string} name
   */
  list(owner, index, size, name) {
    const nothing = { byte: this.start, count: 0, words: 0 };
    if (index >= owner.pointers) return nothing;
    const word = owner.at + owner.dataWords + index;
    const low = this.data.getInt32(8 * word, true);
    const high = this.data.getUint32(8 * word + 4, true);
    if (low === 0 && high === 0) return nothing;
    need((low & 3) === 1 && (high & 7) === size, `${name}: not a list of its kind`);
    const at = word + 1 + (low >> 2);
    const count = high >>> 3;
    if (size !== composite) {
      const bytes = size === oneByte ? count : 4 * count;
      need(at >= 0 && 8 * at + bytes <= 8 * this.words, `${name}: outside the message`);
      return { byte: this.start + 8 * at, count, words: 0 };
    }
    // `count` is the words of the elements; a tag in front of them has their number and shape.
    need(at >= 0 && at + 1 + count <= this.words, `${name}: outside the message`);
    const tag = this.data.getInt32(8 * at, true);
    const elements = tag >> 2;
    const words = this.data.getUint16(8 * at + 4, true) + this.data.getUint16(8 * at + 6, true);
    need((tag & 3) === 0 && elements >= 0, `${name}: a bad tag`);
    need(elements * words <= count, `${name}: more elements than words`);
    // A newer server may have added fields at the end; fewer there cannot be.
    need(elements === 0 || this.data.getUint16(8 * at + 4, true) >= 2, `${name}: too short`);
    return { byte: this.start + 8 * (at + 1), count: elements, words };
  }

  /** @param {{byte: number, count: number}} list */
  floats(list) {
    return new Float32Array(this.buffer, list.byte, list.count);
  }
}

/** @param {DataView} data @param {number} at */
function hex64(data, at) {
  const digits = (/** @type {number} */ word) => word.toString(16).padStart(8, '0');
  return digits(data.getUint32(at + 4, true)) + digits(data.getUint32(at, true));
}

/**
 * @param {Segment} segment
 * @param {{at: number, dataWords: number, pointers: number}} root
 * @param {number} bodies
 * @returns {Shapes | null}
 */
function readShapes(segment, root, bodies) {
  const list = segment.list(root, 4, composite, 'shapes');
  const ids = segment.list(root, 3, fourBytes, 'bodies');
  const vertices = segment.list(root, 5, fourBytes, 'vertices');
  // A world may be empty, and then its definitions are as well.
  if (list.count === 0 && ids.count === 0) return null;
  need(ids.count === bodies, 'bodies: not as many as poses');
  const shapes = {
    count: list.count,
    body: new Uint32Array(list.count),
    radius: new Float32Array(list.count),
    kind: new Uint8Array(list.count),
    first: new Uint32Array(list.count + 1),
    vertices: segment.floats(vertices),
  };
  const data = new DataView(segment.buffer, list.byte, 8 * list.words * list.count);
  for (let i = 0; i < list.count; ++i) {
    const at = 8 * list.words * i;
    const count = data.getUint8(at + 10);
    shapes.body[i] = data.getUint32(at, true);
    shapes.radius[i] = data.getFloat32(at + 4, true);
    shapes.kind[i] = data.getUint16(at + 8, true);
    shapes.first[i + 1] = shapes.first[i] + count;
    need(shapes.body[i] < bodies, `shapes[${i}].body: there is no such body`);
    need(count >= 1 && count <= 8, `shapes[${i}].vertexCount: not 1 to 8`);
    need(shapes.kind[i] < 4, `shapes[${i}].kind: unknown`);
    need(count >= [1, 2, 3, 2][shapes.kind[i]], `shapes[${i}]: too few vertices for its kind`);
  }
  need(2 * shapes.first[list.count] === vertices.count, 'vertices: not as many as the shapes have');
  return shapes;
}

/**
 * @param {ArrayBuffer} buffer one WebSocket message; the View keeps it and reads from it
 * @returns {View}
 * @throws {ViewError}
 */
export function readFrame(buffer) {
  need(buffer.byteLength >= headerBytes + 8, 'frame: too short');
  const head = new DataView(buffer);
  need(head.getUint16(0, true) === magic, 'frame: not of this protocol');
  need(head.getUint8(2) === protocolVersion, `frame: protocol version ${head.getUint8(2)}`);
  need(head.getUint8(3) === viewType, `frame: message type ${head.getUint8(3)} is no View`);
  const payload = head.getUint32(4, true);
  need(payload % 8 === 0 && headerBytes + payload === buffer.byteLength, 'frame: wrong length');

  const segment = new Segment(buffer, headerBytes, payload / 8);
  const root = segment.struct(0, 'View');
  need(root.dataWords >= 3, 'View: too short');
  const at = 8 * root.at;
  const poses = segment.list(root, 0, fourBytes, 'poses');
  const flags = segment.list(root, 1, oneByte, 'flags');
  const contacts = segment.list(root, 2, composite, 'contacts');
  const joints = segment.list(root, 6, fourBytes, 'joints');
  const score = segment.list(root, 7, oneByte, 'score');
  need(poses.count === 4 * flags.count, 'flags: not one for each pose');
  need(joints.count % 4 === 0, 'joints: not four numbers each');
  return {
    tick: segment.data.getUint32(at, true) + 2 ** 32 * segment.data.getUint32(at + 4, true),
    root: hex64(segment.data, at + 8),
    players: segment.data.getUint32(at + 16, true),
    definitions: segment.data.getUint32(at + 20, true),
    bodies: flags.count,
    poses: segment.floats(poses),
    flags: new Uint8Array(buffer, flags.byte, flags.count),
    contacts: {
      count: contacts.count,
      stride: 2 * contacts.words,
      floats: new Float32Array(buffer, contacts.byte, 2 * contacts.words * contacts.count),
      bytes: new Uint8Array(buffer, contacts.byte, 8 * contacts.words * contacts.count),
    },
    joints: segment.floats(joints),
    score: new TextDecoder().decode(
      new Uint8Array(buffer, score.byte, Math.max(score.count - 1, 0)),
    ),
    shapes: readShapes(segment, root, flags.count),
  };
}
