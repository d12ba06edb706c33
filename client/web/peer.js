/**
 * A full peer in the page: a world of its own, stepped with the frames of the server, its hash
 * compared with the server's before every step.
 *
 * The rules of the protocol are those of every client (client/replica.h), in the core. Here its
 * bytes are carried between it and the socket, a message a call and for no longer at a time than
 * the page can be without its turn.
 */
import { CoreError } from './core.js';

/** For steps in one go, ms; what is left waits for the page's next turn. */
const turnMs = 12;

/** In the order of `Numbers` in client/wasm/peer_exports.cpp. */
const names = /** @type {const} */ ([
  'tick',
  'root',
  'ticks',
  'hashesCompared',
  'mismatches',
  'corrections',
  'snapshots',
  'connections',
  'resumes',
  'committed',
  'player',
  'waiting',
]);

/**
 * @typedef {object} PeerNumbers
 * @property {number} tick of the world now
 * @property {string} root its motion root, 16 hexadecimal digits
 * @property {number} ticks steps taken with frames of the server
 * @property {number} hashesCompared
 * @property {number} mismatches
 * @property {number} corrections worlds adopted from the server because of one
 * @property {number} snapshots all worlds adopted
 * @property {number} connections
 * @property {number} resumes
 * @property {number} committed frames below this tick are on the server's disk
 * @property {number} player 0 for a spectator
 * @property {number} waiting messages not handled yet
 */

/**
 * Of base64url. What is no ticket is shown as it is: the server says what is wrong with it.
 * @param {string} ticket
 */
function bytesOfTicket(ticket) {
  try {
    const text = atob(ticket.replaceAll('-', '+').replaceAll('_', '/'));
    return Uint8Array.from(text.slice(0, 256), (letter) => letter.charCodeAt(0));
  } catch {
    return new TextEncoder().encode(ticket).slice(0, 256);
  }
}

export class Peer {
  /**
   * @param {import('./core.js').Core} core
   * @param {string} session
   * @param {'spectator' | 'player'} role
   * @param {object} tell
   * @param {(numbers: PeerNumbers) => void} tell.stepped after every tick, and after a correction
   * @param {(view: ArrayBuffer) => void} tell.view a frame with a View of the newest tick
   * @param {(difference: string) => void} tell.differed body, field and both values
   * @param {(sentence: string) => void} tell.failed the connection must end
   * @param {(sentence: string) => void} tell.stopped so has the core
   * @param {string} ticket as `huestep ticket issue` prints it; empty: none
   */
  constructor(core, session, role, tell, ticket = '') {
    this.core = core;
    this.tell = tell;
    const spectator = role === 'spectator' ? 1 : 0;
    this.peer = core.call('peerNew', core.putText(session), spectator, core.why);
    if (!this.peer) throw new CoreError(core.sentence());
    if (ticket) core.call('peerTicket', this.peer, core.put(bytesOfTicket(ticket)));
    /** @type {WebSocket | null} */
    this.socket = null;
    this.busy = false;
    this.definitions = 0;
    this.difference = '';
    /** Where what is held is to be drawn next. @type {{x: number, y: number} | null} */
    this.target = null;
  }

  /** @param {WebSocket} socket */
  connected(socket) {
    this.socket = socket;
    this.guarded(() => {
      this.core.call('peerConnected', this.peer, performance.now());
      this.send();
    });
  }

  disconnected() {
    this.socket = null;
    this.guarded(() => this.core.call('peerDisconnected', this.peer));
  }

  /** @param {ArrayBuffer} data */
  receive(data) {
    this.guarded(() => {
      const { core } = this;
      const bytes = core.put(new Uint8Array(data));
      if (!core.call('peerReceive', this.peer, bytes, core.why)) return this.fail();
      if (!this.busy) this.handle();
    });
  }

  /** @param {() => void} work */
  guarded(work) {
    try {
      work();
    } catch (problem) {
      if (!(problem instanceof CoreError)) throw problem;
      this.busy = false;
      this.tell.stopped(problem.message);
    }
  }

  /** Handles what has come, for a while. */
  handle() {
    const { core } = this;
    const until = performance.now() + turnMs;
    let { tick, snapshots } = this.numbers();
    this.busy = false;
    while (this.socket && core.call('peerWaiting', this.peer) > 0) {
      if (performance.now() > until) {
        this.busy = true;
        window.setTimeout(() => this.guarded(() => this.handle()), 0);
        break;
      }
      if (!core.call('peerTurn', this.peer, performance.now(), core.why)) return this.fail();
      const now = this.numbers();
      if (now.tick === tick && now.snapshots === snapshots) continue;
      ({ tick, snapshots } = now);
      this.tell.stepped(now);
    }
    this.follow();
    this.send();
    this.show();
  }

  /** @returns {PeerNumbers} */
  numbers() {
    const values = this.core.numbers(this.core.call('peerNumbers', this.peer), names.length);
    const entries = names.map((name, i) => [name, Number(values[i])]);
    return {
      ...Object.fromEntries(entries),
      root: values[names.indexOf('root')].toString(16).padStart(16, '0'),
    };
  }

  show() {
    const { core } = this;
    core.call('peerDifference', this.peer, core.output);
    const difference = new TextDecoder().decode(core.take());
    if (difference !== this.difference) this.tell.differed(difference);
    this.difference = difference;
    if (!core.call('peerView', this.peer, this.definitions, core.output)) return;
    this.definitions = core.call('peerDefinitions', this.peer);
    this.tell.view(core.take().buffer);
  }

  send() {
    const { core } = this;
    core.call('peerOutgoing', this.peer, core.output);
    const bytes = core.take();
    if (bytes.length > 0 && this.socket?.readyState === WebSocket.OPEN) this.socket.send(bytes);
  }

  /** Says why to the server and to the page. */
  fail() {
    const sentence = this.core.sentence();
    this.send();
    this.tell.failed(sentence);
  }

  /** Where the world's motions lie: for tests. */
  motions() {
    const { core } = this;
    const world = core.call('peerWorld', this.peer);
    const count = world ? core.call('worldBodyCount', world) : 0;
    const at = world ? core.call('worldMotions', world) : 0;
    return new Float32Array(core.memory.buffer, at, 8 * count);
  }

  /** Place of the player's own body among the motions, or −1. @returns {number} */
  ownBody() {
    return this.core.call('peerOwnBody', this.peer) - 1;
  }

  /**
   * Takes hold of the movable body at a point of the world, if there is one.
   * @param {number} x m
   * @param {number} y
   * @returns {boolean}
   */
  grab(x, y) {
    return this.act('peerGrab', x, y);
  }
  /** Draws it to a point: once a tick, however often a pointer moves. */
  moveGrab(/** @type {number} */ x, /** @type {number} */ y) {
    this.target = { x, y };
  }
  release() {
    this.follow();
    return this.act('peerRelease');
  }
  follow() {
    if (this.target) this.act('peerMoveGrab', this.target.x, this.target.y);
    this.target = null;
  }

  /** @param {string} name @param {...number} values */
  act(name, ...values) {
    const { core } = this;
    const done = core.call(name, this.peer, ...values, performance.now(), core.why) === 1;
    if (done) this.send();
    return done;
  }
}
