/**
 * Where on the canvas a point of the world is, and how mouse, touch and keys move it.
 *
 * World: metres, y up. Canvas: CSS pixels, y down. `scale` is pixels a metre.
 */

/** @typedef {{left: number, right: number, bottom: number, top: number}} Box */

/**
 * @typedef {object} Hand
 * @property {(x: number, y: number) => boolean} take whether there is something to hold there, m
 * @property {(x: number, y: number) => void} move
 * @property {() => void} drop
 */

const closest = 400;
const farthest = 0.05;
const wheelStep = 1.0015;

export class Camera {
  /**
   * @param {HTMLElement} surface
   * @param {() => void} onMove
   * @param {Hand | null} hand what one pointer may hold instead of moving the view
   */
  constructor(surface, onMove, hand = null) {
    this.surface = surface;
    this.onMove = onMove;
    this.hand = hand;
    /** The pointer that holds something. @type {number | null} */
    this.holding = null;
    this.x = 0;
    this.y = 0;
    this.scale = 20;
    /** Whether nobody has moved it since it was fitted. */
    this.fitted = true;
    /** @type {Map<number, {x: number, y: number}>} */
    this.pointers = new Map();
    this.listen();
  }

  get width() {
    return this.surface.clientWidth;
  }
  get height() {
    return this.surface.clientHeight;
  }

  /**
   * Shows a rectangle of the world whole.
   * @param {Box} box m
   * @param {Box} margin pixels
   */
  fit(box, margin) {
    const wide = Math.max(40, this.width - margin.left - margin.right);
    const high = Math.max(40, this.height - margin.top - margin.bottom);
    const scale = Math.min(wide / (box.right - box.left), high / (box.top - box.bottom));
    this.scale = Math.min(closest, Math.max(farthest, scale));
    this.x = (box.left + box.right) / 2 - (margin.left - margin.right) / 2 / this.scale;
    this.y = (box.bottom + box.top) / 2 + (margin.top - margin.bottom) / 2 / this.scale;
    this.fitted = true;
    this.onMove();
  }

  /** @param {number} dx pixels @param {number} dy */
  pan(dx, dy) {
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
    this.moved();
  }

  /**
   * Keeps the world's point under a pixel where it is.
   * @param {number} factor
   * @param {number} px
   * @param {number} py
   */
  zoom(factor, px = this.width / 2, py = this.height / 2) {
    const scale = Math.min(closest, Math.max(farthest, this.scale * factor));
    const fromX = px - this.width / 2;
    const fromY = py - this.height / 2;
    this.x += fromX / this.scale - fromX / scale;
    this.y -= fromY / this.scale - fromY / scale;
    this.scale = scale;
    this.moved();
  }

  moved() {
    this.fitted = false;
    this.onMove();
  }

  listen() {
    const surface = this.surface;
    surface.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    surface.addEventListener('pointerdown', (event) => {
      surface.setPointerCapture(event.pointerId);
      if (this.pointers.size === 0 && this.holding === null && this.hand) {
        const at = this.worldAt(event);
        if (this.hand.take(at.x, at.y)) {
          this.holding = event.pointerId;
          return;
        }
      }
      this.pointers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    });
    surface.addEventListener('pointermove', (event) => this.drag(event));
    for (const end of ['pointerup', 'pointercancel']) {
      surface.addEventListener(end, (event) =>
        this.letGo(/** @type {PointerEvent} */ (event).pointerId),
      );
    }
  }

  /** The world's point under a pointer. @param {PointerEvent} event */
  worldAt(event) {
    return {
      x: this.x + (event.offsetX - this.width / 2) / this.scale,
      y: this.y - (event.offsetY - this.height / 2) / this.scale,
    };
  }

  /** @param {number} x m @param {number} y */
  pixelOf(x, y) {
    return {
      x: this.width / 2 + (x - this.x) * this.scale,
      y: this.height / 2 - (y - this.y) * this.scale,
    };
  }

  /** @param {number} pointer */
  letGo(pointer) {
    if (pointer === this.holding) {
      this.holding = null;
      this.hand?.drop();
    }
    this.pointers.delete(pointer);
  }

  /** @param {WheelEvent} event */
  wheel(event) {
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
    this.zoom(wheelStep ** (-event.deltaY * lines), event.offsetX, event.offsetY);
  }

  /**
   * One pointer pans; two pan by their middle and zoom by their distance.
   * @param {PointerEvent} event
   */
  drag(event) {
    if (event.pointerId === this.holding) {
      const at = this.worldAt(event);
      this.hand?.move(at.x, at.y);
      return;
    }
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = { x: event.offsetX, y: event.offsetY };
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId);
    this.pointers.set(event.pointerId, now);
    if (others.length === 0) return this.pan(now.x - before.x, now.y - before.y);
    const other = others[0][1];
    this.pan((now.x - before.x) / 2, (now.y - before.y) / 2);
    const apart = (/** @type {{x: number, y: number}} */ p) =>
      Math.max(8, Math.hypot(p.x - other.x, p.y - other.y));
    this.zoom(apart(now) / apart(before), (now.x + other.x) / 2, (now.y + other.y) / 2);
  }
}
