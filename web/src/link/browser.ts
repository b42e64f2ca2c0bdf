/** The real surroundings of a link: this page's server, this device's clock. */
import { kProtocol } from '../wire/messages';
import type { SocketLike, Surroundings } from './live_link';

/** RFC 9562 version 7 in spirit: sorts by time of making. crypto.randomUUID needs a secure page, getRandomValues does not. */
export function makeId(nowMs: number = Date.now()): string {
  const random = crypto.getRandomValues(new Uint8Array(10));
  const time = Math.floor(nowMs).toString(16).padStart(12, '0');
  random[0] = (random[0]! & 0x0f) | 0x70;
  random[2] = (random[2]! & 0x3f) | 0x80;
  const tail = [...random].map((byte) => byte.toString(16).padStart(2, '0')).join('');
  return `${time.slice(0, 8)}-${time.slice(8)}-${tail.slice(0, 4)}-${tail.slice(4, 8)}-${tail.slice(8, 20)}`;
}

function connect(): SocketLike {
  const scheme = location.protocol === 'https:' ? 'wss' : 'ws';
  const socket = new WebSocket(`${scheme}://${location.host}/api/live`, kProtocol);
  socket.binaryType = 'arraybuffer';
  const like: SocketLike = {
    onopen: null,
    onmessage: null,
    onclose: null,
    send: (text) => {
      if (socket.readyState === WebSocket.OPEN) socket.send(text);
    },
    close: () => socket.close(),
  };
  socket.onopen = () => like.onopen?.();
  socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) =>
    like.onmessage?.(typeof data === 'string' ? data : new Uint8Array(data));
  socket.onclose = ({ code }) => like.onclose?.(code);
  return like;
}

export const browserSurroundings: Surroundings = {
  connect,
  makeId,
  nowMs: () => Date.now(),
  random: () => Math.random(),
  after: (ms, run) => {
    const timer = setTimeout(run, ms);
    return () => clearTimeout(timer);
  },
};
