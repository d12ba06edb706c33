/**
 * The page of one session: frames come in, each is drawn at the screen's next turn. They are the
 * server's, or those of a world that the page steps itself.
 */
import { Camera } from './camera.js';
import { Core, CoreError } from './core.js';
import { lookOf, looks, Painter } from './draw.js';
import { Feed } from './feed.js';
import { Legend, refreshMs } from './legend.js';
import { boundsOf } from './outline.js';
import { Peer } from './peer.js';
import { readFrame, ViewError } from './view.js';

/** Ticks whose hash is kept for tests. */
const remembered = 1024;

/** @template {HTMLElement} T @param {string} id @returns {T} */
function byId(id) {
  return /** @type {T} */ (document.getElementById(id));
}

const query = new URLSearchParams(location.search);
const session = query.get('session') ?? '';
const asked = query.get('as');
/** How this page takes part: by watching, unless its address says otherwise. */
const role = asked === 'spectator' || asked === 'player' ? asked : null;
/**
 * From the part of the address that is not sent to anyone; it goes once, and out of sight.
 */
const ticket = new URLSearchParams(location.hash.slice(1)).get('ticket') ?? '';
if (ticket) history.replaceState(null, '', location.pathname + location.search);
const surface = /** @type {HTMLCanvasElement} */ (byId('canvas'));
const shown = {
  tick: byId('tick'),
  root: byId('root'),
  players: byId('players'),
  bodies: byId('bodies'),
  awake: byId('awake'),
  contacts: byId('contacts'),
  rate: byId('rate'),
};

/** @type {Feed | null} */
let feed = null;
/** @type {Peer | null} */
let peer = null;
/** @type {import('./view.js').View | null} */
let newest = null;
/**
 * Frames on their way to the screen, oldest first. Two of them, so that two that come in one turn
 * of the screen are shown in two, and an uneven network does not look like an uneven world.
 * @type {import('./view.js').View[]}
 */
const waiting = [];
const mostWaiting = 2;
let paused = false;
let turnAsked = false;
let definitions = 0;
let legendAt = 0;
/** When the frames of the last second came, ms. @type {number[]} */
const arrivals = [];

/** What a test, or a curious person in the console, may look at. */
const huestep = {
  session,
  state: 'connecting',
  tick: 0,
  root: '',
  players: 0,
  bodies: 0,
  asleep: 0,
  contacts: 0,
  joints: 0,
  definitions: 0,
  /** Frames that came, that were drawn, and that newer ones overtook before the screen's turn. */
  received: 0,
  drawn: 0,
  overtaken: 0,
  /** Ticks that no frame told of. */
  missed: 0,
  losses: 0,
  badFrames: 0,
  /** ms that drawing the last frames took. @type {number[]} */
  drawMs: [],
  /** @type {{tick: number, root: string}[]} */
  history: [],
  /** Of a page that steps the world itself; lanes are those of its core, 0 for one that watches. */
  lanes: 0,
  player: 0,
  hashesCompared: 0,
  mismatches: 0,
  corrections: 0,
  snapshots: 0,
  connections: 0,
  difference: '',
  /** How the game stands, where one is played. */
  score: '',
  /** What moves in the page's own world, where it lies in the core's memory. */
  motions: () => peer?.motions(),
  /** Where the player's own body is, in pixels of the canvas; null if it has none. */
  ownBody: () => {
    const at = peer?.ownBody() ?? -1;
    if (at < 0 || !peer) return null;
    const [x, y] = peer.motions().slice(8 * at, 8 * at + 2);
    return camera.pixelOf(x, y);
  },
  /** @type {Record<string, number>} */
  looks: {},
};
Object.assign(window, { huestep });

const hand =
  role === 'player'
    ? {
        take: (/** @type {number} */ x, /** @type {number} */ y) =>
          peer?.grab(x, y) ?? false,
        move: (/** @type {number} */ x, /** @type {number} */ y) => peer?.moveGrab(x, y),
        drop: () => peer?.release(),
      }
    : null;
const camera = new Camera(surface, () => redraw(), hand);
const painter = new Painter(surface, camera);
const legend = new Legend(byId('body-legend'), byId('moving-legend'), byId('fixed-legend'));

function redraw() {
  if (!turnAsked) requestAnimationFrame(draw);
  turnAsked = true;
}

function fit() {
  if (!newest) return;
  const gap = Math.min(24, camera.width / 24);
  const foot = byId('foot').offsetHeight;
  camera.fit(boundsOf(painter.outlines, newest), {
    left: gap,
    right: gap,
    top: gap,
    bottom: gap + foot,
  });
}

/** @param {ArrayBuffer} frame */
function take(frame) {
  let view;
  try {
    view = readFrame(frame);
  } catch (problem) {
    if (!(problem instanceof ViewError) && !(problem instanceof RangeError)) throw problem;
    huestep.badFrames += 1;
    return feed?.reject();
  }
  // A server whose session stands still repeats its newest frame, as a sign of life.
  const repeated = view.tick === huestep.tick && view.root === huestep.root && !view.shapes;
  if (repeated && huestep.received > 0) return;
  if (view.tick > huestep.tick + 1 && huestep.received > 0)
    huestep.missed += view.tick - huestep.tick - 1;
  huestep.received += 1;
  huestep.tick = view.tick;
  huestep.root = view.root;
  if (!peer) remember(view);
  arrivals.push(performance.now());
  waiting.push(view);
  while (waiting.length > mostWaiting) {
    inherit(/** @type {import('./view.js').View} */ (waiting.shift()), waiting[0]);
    if (!paused) huestep.overtaken += 1;
  }
  if (!paused) redraw();
}

/** @param {{tick: number, root: string}} state after a tick */
function remember({ tick, root }) {
  huestep.history.push({ tick, root });
  if (huestep.history.length > remembered) huestep.history.shift();
}

/** @param {import('./peer.js').PeerNumbers} numbers */
function stepped(numbers) {
  remember(numbers);
  const { player, hashesCompared, mismatches, corrections, snapshots, connections } = numbers;
  Object.assign(huestep, {
    player,
    hashesCompared,
    mismatches,
    corrections,
    snapshots,
    connections,
  });
}

function showAgreement() {
  const { hashesCompared, mismatches } = huestep;
  const shownAs = byId('agreement');
  shownAs.textContent = `${hashesCompared - mismatches} of ${hashesCompared}`;
  shownAs.dataset.agree = String(mismatches === 0);
}

/** @param {string} score */
function showScore(score) {
  if (score === huestep.score) return;
  huestep.score = score;
  byId('score').hidden = score === '';
  byId('score').textContent = score;
}

/** @param {string} difference */
function showDifference(difference) {
  huestep.difference = difference;
  const line = byId('difference');
  line.hidden = difference === '';
  line.textContent =
    `This page's world differed from the server's, which it has taken over: ${difference}`;
}

/**
 * The server sends shapes once: a frame that is not shown leaves them to the next.
 * @param {import('./view.js').View} from
 * @param {import('./view.js').View} to
 */
function inherit(from, to) {
  if (!to.shapes && from.definitions === to.definitions) to.shapes = from.shapes;
}

/** Makes the next frame the newest on the screen. @returns {boolean} whether there was one */
function advance() {
  const view = paused ? undefined : waiting.shift();
  if (!view) return false;
  if (waiting.length > 0) redraw();
  const first = definitions === 0;
  if (view.shapes || view.bodies === 0) {
    definitions = view.definitions;
    painter.define(view.shapes);
  }
  // Poses without their shapes cannot be drawn; the server does not send any.
  if (view.definitions !== definitions) return false;
  newest = view;
  if (first) fit();
  return true;
}

/** @param {import('./view.js').View} view */
function showNumbers(view) {
  const counts = looks.map(() => 0);
  let asleep = 0;
  let awake = 0;
  for (const flags of view.flags) {
    counts[lookOf(flags)] += 1;
    if (((flags >> 1) & 3) === 2) {
      if (flags & 1) asleep += 1;
      else awake += 1;
    }
  }
  Object.assign(huestep, {
    players: view.players,
    bodies: view.bodies,
    contacts: view.contacts.count,
    joints: view.joints.length / 4,
    asleep,
    definitions: view.definitions,
  });
  looks.forEach((look, i) => {
    huestep.looks[look] = counts[i];
  });
  shown.tick.textContent = String(view.tick);
  shown.root.textContent = view.root;
  shown.players.textContent = String(view.players);
  shown.bodies.textContent = String(view.bodies);
  shown.awake.textContent = String(awake);
  shown.contacts.textContent = String(view.contacts.count);
  showScore(view.score);
  if (peer) showAgreement();
  const now = performance.now();
  if (now - legendAt < refreshMs) return;
  legendAt = now;
  legend.show(counts, view);
  byId('scale').textContent = `${Number(painter.gridStep().toPrecision(1))} m`;
  byId('ruler').style.width = `${painter.gridStep() * camera.scale}px`;
}

function draw() {
  turnAsked = false;
  const begin = performance.now();
  const fresh = advance();
  if (newest && fresh) showNumbers(newest);
  painter.draw(newest);
  if (!fresh) return;
  huestep.drawn += 1;
  huestep.drawMs.push(performance.now() - begin);
  if (huestep.drawMs.length > remembered) huestep.drawMs.shift();
}

/** @param {string} state @param {string} sentence */
function showState(state, sentence) {
  huestep.state = state;
  huestep.losses = feed?.losses ?? 0;
  const line = byId('state');
  line.dataset.state = paused && state === 'live' ? 'paused' : state;
  line.textContent = paused && state === 'live' ? 'paused' : sentence;
  document.body.classList.toggle('stale', state !== 'live');
}

function pause() {
  paused = !paused;
  const button = byId('pause');
  button.setAttribute('aria-pressed', String(paused));
  button.textContent = paused ? 'Resume' : 'Pause';
  showState(huestep.state, huestep.state);
  redraw();
}

function resize() {
  painter.resize();
  if (camera.fitted) fit();
  painter.draw(newest); // at once: a canvas of a new size is empty
}

window.setInterval(() => {
  const since = performance.now() - 1000;
  while (arrivals.length > 0 && arrivals[0] < since) arrivals.shift();
  shown.rate.textContent = String(arrivals.length);
  if (huestep.state === 'live' && !paused)
    showState('live', arrivals.length > 0 ? 'live' : 'standing still');
}, 500);

byId('session').textContent = session;
document.title = `${session} · Huestep`;
byId('fit').addEventListener('click', fit);
byId('pause').addEventListener('click', pause);
byId('closer').addEventListener('click', () => camera.zoom(1.4));
byId('farther').addEventListener('click', () => camera.zoom(1 / 1.4));
surface.addEventListener('dblclick', fit);
window.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.target instanceof HTMLButtonElement)
    return;
  /** @type {Record<string, () => void>} */
  const keys = {
    ' ': pause,
    f: fit,
    '+': () => camera.zoom(1.4),
    '=': () => camera.zoom(1.4),
    '-': () => camera.zoom(1 / 1.4),
    ArrowLeft: () => camera.pan(60, 0),
    ArrowRight: () => camera.pan(-60, 0),
    ArrowUp: () => camera.pan(0, 60),
    ArrowDown: () => camera.pan(0, -60),
  };
  const action = keys[event.key];
  if (!action) return;
  event.preventDefault();
  action();
});
window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
  painter.restyle();
  redraw();
});
const sizes = new ResizeObserver(resize);
sizes.observe(surface);
sizes.observe(byId('foot'));
painter.resize();

for (const link of document.querySelectorAll('#modes a')) {
  const as = /** @type {HTMLElement} */ (link).dataset.as ?? '';
  const there = new URLSearchParams({ session, ...(as && { as }) });
  link.setAttribute('href', `/?${there}`);
  if (as === (role ?? '')) link.setAttribute('aria-current', 'page');
}

/** @param {'spectator' | 'player'} as @returns {Promise<Peer>} */
async function makePeer(as) {
  const core = await Core.load();
  huestep.lanes = core.lanes;
  return new Peer(core, session, as, {
    stepped,
    view: take,
    differed: showDifference,
    failed: (sentence) => feed?.reject(sentence),
    stopped: (sentence) => {
      if (feed) feed.peer = null;
      onlyWatch(sentence);
      feed?.reject('the core of this page stopped');
    },
  }, ticket);
}

/** @param {string} sentence why */
function onlyWatch(sentence) {
  peer = null;
  byId('agreement-box').hidden = true;
  const line = byId('difference');
  line.hidden = false;
  line.textContent = `This page only watches: ${sentence}`;
}

async function start() {
  if (role) {
    showState('connecting', 'loading the core');
    try {
      peer = await makePeer(role);
      byId('agreement-box').hidden = false;
    } catch (problem) {
      if (!(problem instanceof CoreError)) throw problem;
      onlyWatch(problem.message);
    }
  }
  // Starts by itself, and tells its state before it is here.
  feed = new Feed(session, take, showState, peer, ticket);
}
start();
