/**
 * The WebSocket of one session: frames in, and a connection that comes back by itself.
 *
 * After a loss it waits 0.5 s, then twice as long each time up to 8 s, each wait shortened at
 * random by up to a quarter so that the viewers of a restarted server do not come at one moment.
 */

const firstWaitMs = 500;
const longestWaitMs = 8000;
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
   */
  constructor(session, onFrame, onState) {
    this.session = session;
    this.onFrame = onFrame;
    this.onState = onState;
    this.waitMs = firstWaitMs;
    /** How often the connection was lost or refused. */
    this.losses = 0;
    /** @type {WebSocket | null} */
    this.socket = null;
    this.timer = 0;
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
    const socket = new WebSocket(`${scheme}//${location.host}/view?${query}`, 'huestep-view');
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    let opened = false;
    socket.onopen = () => {
      opened = true;
      this.waitMs = firstWaitMs;
      this.onState('live', 'live');
    };
    socket.onmessage = (event) => this.onFrame(event.data);
    socket.onclose = (event) => {
      if (this.socket !== socket) return;
      this.lost(event.code === goingAway ? 'the server stopped' : 'connection lost', opened);
    };
  }

  /** Ends the connection because of what came over it; it is tried again like any other loss. */
  reject() {
    this.socket?.close(4000, 'bad frame');
  }

  /** @param {string} reason @param {boolean} opened false: it never came about */
  async lost(reason, opened) {
    this.socket = null;
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
      const reply = await fetch(location.href, { method: 'HEAD' });
      if (reply.status === 404) return 'the server has no such session';
      if (reply.status === 429) return 'the server asks to wait';
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
