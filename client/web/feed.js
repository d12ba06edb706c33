/**
 * The WebSocket of one session: frames in, or a peer's bytes in and out, and a connection that
 * comes back by itself.
 *
 * After a loss it waits 0.5 s, then twice as long each time up to 8 s, each wait shortened at
 * random by up to a quarter so that the viewers of a restarted server do not come at one moment.
 *
 * A server that lives sends something every few seconds, even while its session stands still. One
 * from which nothing comes for 10 s is given up: a line that broke without a word says no more.
 * That time is counted in beats of a timer: a page that slept missed beats as well, and does not
 * take its own absence for the server's silence.
 */

const firstWaitMs = 500;
const longestWaitMs = 8000;
const beatMs = 1000;
/** Beats without a message, or without an answer to the first word. */
const silentAfter = 10;
/** The close code of a server that stops. */
const goingAway = 1001;

/**
 * @typedef {'connecting' | 'live' | 'waiting'} FeedState
 */

export class Feed {
  /**
   * @param {string} session
   * @param {(frame: ArrayBuffer) => void} onFrame
   * @param {(state: FeedState, sentence: string) => void} onState the sentence is for people
   * @param {import('./peer.js').Peer | null} peer takes part instead of watching
   * @param {string} ticket of who watches, where the server asks for one; a peer has its own
   */
  constructor(session, onFrame, onState, peer = null, ticket = '') {
    this.session = session;
    this.onFrame = onFrame;
    this.onState = onState;
    this.peer = peer;
    this.ticket = ticket;
    this.waitMs = firstWaitMs;
    /** How often the connection was lost or refused. */
    this.losses = 0;
    /** @type {WebSocket | null} */
    this.socket = null;
    this.timer = 0;
    this.quietBeats = 0;
    window.setInterval(() => this.beat(), beatMs);
    window.addEventListener('online', () => this.hurry());
    document.addEventListener('visibilitychange', () => document.hidden || this.hurry());
    this.connect();
  }

  connect() {
    window.clearInterval(this.timer);
    this.timer = 0;
    this.onState('connecting', 'connecting');
    const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
    const query = new URLSearchParams({ session: this.session });
    if (this.ticket && !this.peer) query.set('ticket', this.ticket);
    const door = this.peer ? 'peer' : 'view';
    const socket = new WebSocket(`${scheme}//${location.host}/${door}?${query}`, `huestep-${door}`);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    this.quietBeats = 0;
    let opened = false;
    socket.onopen = () => {
      if (this.socket !== socket) return;
      opened = true;
      this.quietBeats = 0;
      this.waitMs = firstWaitMs;
      this.onState('live', 'live');
      this.peer?.connected(socket);
    };
    socket.onmessage = (event) => {
      if (this.socket !== socket) return;
      this.quietBeats = 0;
      if (this.peer) this.peer.receive(event.data);
      else this.onFrame(event.data);
    };
    socket.onclose = (event) => {
      if (this.socket !== socket) return;
      this.lost(event.code === goingAway ? 'the server stopped' : 'connection lost', opened);
    };
  }

  beat() {
    if (!this.socket) return;
    this.quietBeats += 1;
    if (this.quietBeats < silentAfter) return;
    // The browser would wait for the other side's word before it tells of the end.
    this.socket.close(4001, 'silence');
    this.lost('the server is silent', true);
  }

  /** Ends the connection because of what came over it; it is tried again like any other loss. */
  reject(reason = '') {
    if (!this.socket) return;
    this.socket.close(4000, 'bad frame');
    // The other side's close tells of it, unless there is more to say.
    if (reason) this.lost(reason, true);
  }

  /** @param {string} reason @param {boolean} opened false: it never came about */
  async lost(reason, opened) {
    this.socket = null;
    this.peer?.disconnected();
    this.losses += 1;
    const until = performance.now() + this.waitMs * (1 - Math.random() / 4);
    this.waitMs = Math.min(2 * this.waitMs, longestWaitMs);
    const tell = () => {
      const left = Math.ceil((until - performance.now()) / 1000);
      if (left > 0) this.onState('waiting', `${reason}, again in ${left} s`);
      else this.connect();
    };
    this.timer = window.setInterval(tell, 250);
    tell();
    if (!opened) reason = await this.whyRefused();
  }

  /** A WebSocket does not say why it was refused; the page's own address does. */
  async whyRefused() {
    try {
      const signal = AbortSignal.timeout(beatMs * silentAfter);
      const reply = await fetch(location.href, { method: 'HEAD', signal });
      if (reply.status === 404) return 'the server has no such session';
      if (reply.status === 429) return 'the server asks to wait';
      if (reply.headers.has('x-huestep-tickets') && !this.peer)
        return 'the server lets in who has a ticket that is not used up';
      return 'the server takes no more viewers';
    } catch {
      return 'the server does not answer';
    }
  }

  /** Tries now, if it was waiting. */
  hurry() {
    if (this.timer) this.connect();
  }
}
