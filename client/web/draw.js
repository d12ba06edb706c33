/** Draws a View: the ground's grid, bodies by type, contacts by graph colour. */
import { outlinesOf, trace } from './outline.js';

/**
 * Graph colours as the server numbers them (core/graph/coloring.h): 0 to 63 for contacts between
 * two moving bodies, 65 for those of hubs, from 66 for those with one moving body, 131 for those of
 * hubs with one, 255 for what found no colour.
 */
export const firstFixedColour = 66;
export const overflowColour = 255;
/** Colours beyond the last of the palette share its last entry. */
export const paletteSize = 12;

/** How a body looks; later ones are drawn over earlier ones. */
export const looks = /** @type {const} */ (['static', 'asleep', 'kinematic', 'awake', 'player']);
const [lookStatic, lookAsleep, lookKinematic, lookAwake, lookPlayer] = [0, 1, 2, 3, 4];

/** Shapes to one path. Long paths are slow to fill, short ones cost a call each. */
const shapesAPath = 64;
/** Below this many pixels nobody sees that a corner is round. */
const roundPixels = 1.5;
const roundDotPixels = 1.8;

/** @param {number} flags of a View @returns {number} place in `looks` */
export function lookOf(flags) {
  if (flags & 8) return lookPlayer;
  const type = (flags >> 1) & 3;
  if (type === 0) return lookStatic;
  if (flags & 1) return lookAsleep;
  return type === 1 ? lookKinematic : lookAwake;
}

/**
 * @param {number} colour of a View's contact
 * @returns {{fixed: boolean, place: number}} place in the palette
 */
export function swatchOf(colour) {
  const fixed = colour >= firstFixedColour;
  const number = fixed ? colour - firstFixedColour : colour;
  return { fixed, place: Math.min(number, paletteSize - 1) };
}

export class Painter {
  /** @param {HTMLCanvasElement} element @param {import('./camera.js').Camera} camera */
  constructor(element, camera) {
    this.element = element;
    this.camera = camera;
    this.canvas = /** @type {CanvasRenderingContext2D} */ (
      element.getContext('2d', { alpha: false })
    );
    /** @type {import('./outline.js').Outline[]} */
    this.outlines = [];
    /** Shapes of each look, made anew for each view. @type {number[][]} */
    this.byLook = looks.map(() => []);
    this.pixels = 1;
    this.style = this.readStyle();
  }

  /** Takes the colours from the style sheet, where light and dark are decided. */
  restyle() {
    this.style = this.readStyle();
  }

  readStyle() {
    const style = getComputedStyle(document.documentElement);
    const value = (/** @type {string} */ name) => style.getPropertyValue(`--${name}`).trim();
    return {
      ground: value('canvas'),
      grid: value('grid'),
      fills: looks.map((look) => value(`${look}-fill`)),
      lines: looks.map((look) => value(`${look}-line`)),
      palette: Array.from({ length: paletteSize }, (_, i) => value(`colour-${i}`)),
      overflow: value('overflow'),
      joint: value('joint'),
    };
  }

  /** @param {import('./view.js').Shapes | null} shapes null: an empty world's */
  define(shapes) {
    this.outlines = shapes ? outlinesOf(shapes) : [];
  }

  resize() {
    this.pixels = Math.min(2, window.devicePixelRatio || 1);
    const width = Math.max(1, Math.round(this.camera.width * this.pixels));
    const height = Math.max(1, Math.round(this.camera.height * this.pixels));
    if (width === this.element.width && height === this.element.height) return;
    this.element.width = width;
    this.element.height = height;
  }

  /** @param {import('./view.js').View | null} view */
  draw(view) {
    const { canvas, camera, pixels } = this;
    canvas.setTransform(1, 0, 0, 1, 0, 0);
    canvas.fillStyle = this.style.ground;
    canvas.fillRect(0, 0, this.element.width, this.element.height);
    const scale = camera.scale * pixels;
    canvas.setTransform(
      scale,
      0,
      0,
      -scale,
      this.element.width / 2 - camera.x * scale,
      this.element.height / 2 + camera.y * scale,
    );
    this.drawGrid();
    if (!view) return;
    this.drawBodies(view);
    this.drawJoints(view.joints);
    this.drawContacts(view);
  }

  /** Metres from line to line, so that they are 60 to 150 pixels apart: 1, 2 or 5 times 10^n. */
  gridStep() {
    const wanted = 60 / this.camera.scale;
    const power = 10 ** Math.floor(Math.log10(wanted));
    return power * ([1, 2, 5].find((k) => k * power >= wanted) ?? 10);
  }

  drawGrid() {
    const { canvas, camera } = this;
    const step = this.gridStep();
    const halfWidth = camera.width / 2 / camera.scale;
    const halfHeight = camera.height / 2 / camera.scale;
    canvas.beginPath();
    for (
      let x = Math.ceil((camera.x - halfWidth) / step) * step;
      x < camera.x + halfWidth;
      x += step
    ) {
      canvas.moveTo(x, camera.y - halfHeight);
      canvas.lineTo(x, camera.y + halfHeight);
    }
    for (
      let y = Math.ceil((camera.y - halfHeight) / step) * step;
      y < camera.y + halfHeight;
      y += step
    ) {
      canvas.moveTo(camera.x - halfWidth, y);
      canvas.lineTo(camera.x + halfWidth, y);
    }
    canvas.lineWidth = 1 / camera.scale;
    canvas.strokeStyle = this.style.grid;
    canvas.stroke();
  }

  /** @param {import('./view.js').View} view */
  drawBodies(view) {
    for (const list of this.byLook) list.length = 0;
    this.outlines.forEach((outline, i) => {
      if (outline.body < view.bodies) this.byLook[lookOf(view.flags[outline.body])].push(i);
    });
    this.byLook.forEach((list, look) => {
      for (let first = 0; first < list.length; first += shapesAPath) {
        this.drawShapes(view.poses, list.slice(first, first + shapesAPath), look);
      }
    });
  }

  /** @param {Float32Array} poses @param {number[]} shapes @param {number} look */
  drawShapes(poses, shapes, look) {
    const { canvas, camera } = this;
    canvas.beginPath();
    for (const i of shapes) {
      const outline = this.outlines[i];
      trace(canvas, outline, poses, outline.radius * camera.scale > roundPixels);
    }
    canvas.fillStyle = this.style.fills[look];
    canvas.fill();
    // Lines grow with the bodies, within limits: a far pile must not turn into nothing but lines.
    const width = Math.min(1.5, Math.max(0.6, camera.scale / 16)) * (look === lookPlayer ? 1.6 : 1);
    canvas.lineWidth = width / camera.scale;
    canvas.lineJoin = 'round';
    canvas.strokeStyle = this.style.lines[look];
    canvas.stroke();
  }

  /** A line from end to end, and a pin where they meet. @param {Float32Array} joints */
  drawJoints(joints) {
    if (joints.length === 0) return;
    const { canvas, camera } = this;
    const pin = Math.min(2.2, Math.max(0.8, camera.scale / 14)) / camera.scale;
    canvas.strokeStyle = this.style.joint;
    canvas.fillStyle = this.style.joint;
    canvas.lineWidth = Math.min(1.5, Math.max(0.6, camera.scale / 18)) / camera.scale;
    // Many short paths: a long one of crossing lines is slow to stroke.
    for (let first = 0; first < joints.length; first += 4 * shapesAPath) {
      const end = Math.min(joints.length, first + 4 * shapesAPath);
      canvas.beginPath();
      for (let i = first; i < end; i += 4) {
        canvas.moveTo(joints[i], joints[i + 1]);
        canvas.lineTo(joints[i + 2], joints[i + 3]);
      }
      canvas.stroke();
      canvas.beginPath();
      for (let i = first; i < end; i += 4) {
        canvas.moveTo(joints[i + 2] + pin, joints[i + 3]);
        canvas.arc(joints[i + 2], joints[i + 3], pin, 0, 2 * Math.PI);
      }
      canvas.fill();
    }
  }

  /**
   * Discs between moving bodies, rings against what does not move, squares for the overflow.
   * @param {import('./view.js').View} view
   */
  drawContacts(view) {
    /** @type {Map<number, number[]>} */
    const byColour = new Map();
    const { count, stride, bytes } = view.contacts;
    for (let i = 0; i < count; ++i) {
      const colour = bytes[4 * stride * i + 8];
      const list = byColour.get(colour);
      if (list) list.push(i);
      else byColour.set(colour, [i]);
    }
    for (const [colour, list] of byColour) {
      if (colour === overflowColour) this.drawOverflow(view.contacts, list);
      else this.drawDots(view.contacts, list, colour);
    }
  }

  dotPixels() {
    return Math.min(3.2, Math.max(1.3, this.camera.scale / 9));
  }

  /**
   * @param {import('./view.js').Contacts} contacts
   * @param {number[]} list
   * @param {number} colour
   */
  drawDots(contacts, list, colour) {
    const { canvas, camera } = this;
    const swatch = swatchOf(colour);
    const pixels = this.dotPixels();
    const ring = swatch.fixed && pixels > 2;
    const radius = (ring ? pixels - 0.6 : pixels) / camera.scale;
    canvas.beginPath();
    for (const i of list) {
      const x = contacts.floats[contacts.stride * i];
      const y = contacts.floats[contacts.stride * i + 1];
      if (pixels * this.pixels > roundDotPixels) {
        canvas.moveTo(x + radius, y);
        canvas.arc(x, y, radius, 0, 2 * Math.PI);
      } else {
        canvas.rect(x - radius, y - radius, 2 * radius, 2 * radius);
      }
    }
    if (ring) {
      canvas.lineWidth = 1.5 / camera.scale;
      canvas.strokeStyle = this.style.palette[swatch.place];
      canvas.stroke();
    } else {
      canvas.fillStyle = this.style.palette[swatch.place];
      canvas.fill();
    }
  }

  /** @param {import('./view.js').Contacts} contacts @param {number[]} list */
  drawOverflow(contacts, list) {
    const half = (1.3 * this.dotPixels()) / this.camera.scale;
    this.canvas.fillStyle = this.style.overflow;
    for (const i of list) {
      this.canvas.fillRect(
        contacts.floats[contacts.stride * i] - half,
        contacts.floats[contacts.stride * i + 1] - half,
        2 * half,
        2 * half,
      );
    }
  }
}
