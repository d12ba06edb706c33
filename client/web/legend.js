/** The legend: what each look of a body and each colour of a contact means, with their numbers. */
import { looks, overflowColour, paletteSize, swatchOf } from './draw.js';

/** The legend's numbers are for reading, not for following: a few times a second is enough. */
export const refreshMs = 250;

const words = {
  static: 'fixed',
  asleep: 'asleep',
  kinematic: 'driven',
  awake: 'awake',
  player: "player's",
};

/** @param {string} className @param {string} text */
function span(className, text) {
  const element = document.createElement('span');
  element.className = className;
  element.textContent = text;
  return element;
}

export class Legend {
  /**
   * @param {HTMLElement} bodies
   * @param {HTMLElement} moving contacts between moving bodies
   * @param {HTMLElement} fixed and with others
   */
  constructor(bodies, moving, fixed) {
    this.lists = [moving, fixed, moving];
    this.lookCounts = looks.map((look) => this.entry(bodies, `body ${look}`, words[look], look));
    this.joints = this.entry(bodies, 'joint', 'joints', 'joint');
    /**
     * Made when their colour is first seen; like all entries they stay.
     * @type {Map<string, {item: HTMLElement, count: HTMLElement}>}
     */
    this.colours = new Map();
  }

  /** @param {HTMLElement} list @param {string} swatch @param {string} name @param {string} title */
  entry(list, swatch, name, title) {
    const item = document.createElement('li');
    item.title = title;
    const count = span('count', '');
    item.hidden = true; // until there is one
    item.append(span(`swatch ${swatch}`, ''), span('name', name), count);
    list.append(item);
    return { item, count };
  }

  /** @param {string} key of the form "0 3": 0 moving or 1 fixed or 2 overflow, and the place */
  colourEntry(key) {
    const known = this.colours.get(key);
    if (known) return known;
    const [kind, place] = key.split(' ').map(Number);
    const name = kind === 2 ? 'overflow' : `${place}${place === paletteSize - 1 ? '+' : ''}`;
    const what = ['between moving bodies', 'with a fixed or driven body', 'without a colour'][kind];
    const swatch = kind === 2 ? 'dot overflow' : `${kind === 1 ? 'ring' : 'dot'} c${place}`;
    const made = this.entry(
      this.lists[kind],
      swatch,
      name,
      `contacts ${what}, graph colour ${name}`,
    );
    made.item.hidden = false;
    this.colours.set(key, made);
    for (const each of [...this.colours.keys()].sort(compareKeys)) {
      const { item } = /** @type {{item: HTMLElement}} */ (this.colours.get(each));
      item.parentElement?.append(item);
    }
    return made;
  }

  /** @param {number[]} lookCounts bodies of each look @param {import('./view.js').View} view */
  show(lookCounts, { contacts, joints }) {
    if (joints.length > 0) this.joints.item.hidden = false;
    this.joints.count.textContent = String(joints.length / 4);
    this.joints.item.classList.toggle('none', joints.length === 0);
    this.lookCounts.forEach(({ item, count }, look) => {
      if (lookCounts[look] > 0) item.hidden = false;
      count.textContent = String(lookCounts[look]);
      item.classList.toggle('none', lookCounts[look] === 0);
    });
    /** @type {Map<string, number>} */
    const counts = new Map();
    for (let i = 0; i < contacts.count; ++i) {
      const colour = contacts.bytes[4 * contacts.stride * i + 8];
      const { fixed, place } = swatchOf(colour);
      const key = colour === overflowColour ? '2 0' : `${fixed ? 1 : 0} ${place}`;
      counts.set(key, (counts.get(key) ?? 0) + 1);
    }
    for (const key of counts.keys()) this.colourEntry(key);
    for (const [key, { item, count }] of this.colours) {
      count.textContent = String(counts.get(key) ?? 0);
      item.classList.toggle('none', !counts.has(key));
    }
  }
}

/** @param {string} a @param {string} b */
function compareKeys(a, b) {
  const [kindA, placeA] = a.split(' ').map(Number);
  const [kindB, placeB] = b.split(' ').map(Number);
  return kindA - kindB || placeA - placeB;
}
