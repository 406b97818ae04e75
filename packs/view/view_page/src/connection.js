// Connection to the server: requests with answers, wanted streams, and packets that arrive.
import { readPacket } from './packet.js';

const token = new URLSearchParams(location.search).get('token') ?? '';

const SERVED = new Set(['log']); // requests that the server answers for a recording, too

export class Connection {
  /** `receive(packet)` is called for each packet, `report(text)` for an error without a request. */
  constructor(receive, report, onLink) {
    Object.assign(this, { receive, report, onLink });
    this.wants = {};
    this.pending = new Map();
    this.number = 0;
    this.delay = 500;
    this.bytes = this.packets = 0;
    document.addEventListener('visibilitychange', () => (document.hidden ? this.close() : this.open()));
  }

  open() {
    if (this.socket || document.hidden || window.simkitFile) return;
    const socket = new WebSocket(new URL(`ws?token=${encodeURIComponent(token)}`, location.href.replace(/^http/, 'ws')));
    this.socket = socket;
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.delay = 500;
      this.sendWants();
      this.onLink(true);
    };
    socket.onmessage = event => this.take(event.data);
    socket.onclose = () => {
      if (this.socket !== socket) return;
      this.socket = null;
      for (const { reject } of this.pending.values()) reject(new Error('the connection has ended'));
      this.pending.clear();
      this.onLink(false);
      if (!document.hidden) setTimeout(() => this.open(), (this.delay = Math.min(2 * this.delay, 5000)));
    };
  }

  /** Ends the connection: a hidden page costs the simulation nothing. */
  close() {
    const socket = this.socket;
    this.socket = null;
    socket?.close();
    if (socket) this.onLink(false);
  }

  take(data) {
    if (typeof data !== 'string') {
      this.bytes += data.byteLength;
      this.packets += 1;
      this.receive(readPacket(data));
      return;
    }
    const answer = JSON.parse(data);
    const waiting = this.pending.get(answer.id);
    this.pending.delete(answer.id);
    if (waiting && 'ok' in answer) waiting.resolve(answer.ok);
    else if (waiting) waiting.reject(new Error(answer.error));
    else if (answer.error) this.report(answer.error);
  }

  /** Sends a request; returns a promise of its answer. */
  ask(name, args = {}) {
    if (this.player && !SERVED.has(name)) return this.player.ask(name, args);
    if (this.socket?.readyState !== WebSocket.OPEN) return Promise.reject(new Error('there is no connection'));
    const id = ++this.number;
    this.socket.send(JSON.stringify({ ...args, do: name, id }));
    return new Promise((resolve, reject) => this.pending.set(id, { resolve, reject }));
  }

  /** Sends a request; an error is reported to the user. */
  send(name, args = {}) {
    return this.ask(name, args).catch(error => this.report(error.message));
  }

  /** Asks for a stream, with its options; null ends it. */
  want(stream, options) {
    if (JSON.stringify(this.wants[stream] ?? null) === JSON.stringify(options)) return;
    if (options === null) delete this.wants[stream];
    else this.wants[stream] = options;
    this.sendWants();
  }

  sendWants() {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify({ do: 'want', streams: this.wants }));
  }

  async loadScene() {
    if (window.simkitFile) return readPacket(window.simkitFile.scene);
    return readPacket(await (await this.fetch('scene')).arrayBuffer());
  }

  async fetch(name) {
    const answer = await fetch(`${name}?token=${encodeURIComponent(token)}`);
    if (!answer.ok) throw new Error(await answer.text());
    return answer;
  }
}
