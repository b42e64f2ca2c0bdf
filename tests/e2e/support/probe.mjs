// Listens to the live protocol beside the page, to know what a test should find: tables by part, as the server tells them.
import { createRequire } from 'node:module';

const { WebSocket } = createRequire(new URL('../../../web/package.json', import.meta.url))('ws');

export class Probe {
  tables = {};
  #socket;

  static async open(url) {
    const answer = await fetch(new URL('/api/pair', url), {
      method: 'POST',
      headers: { 'Content-Type': 'application/json' },
      body: JSON.stringify({ name: 'Probe', role: 'observer' }),
    });
    const { token } = await answer.json();
    const probe = new Probe();
    probe.#socket = new WebSocket(new URL('/api/live', url.replace('http', 'ws')), 'smokemap.v1', { origin: new URL(url).origin });
    probe.#socket.on('message', (data, isBinary) => !isBinary && probe.#take(JSON.parse(data.toString())));
    await new Promise((resolve, reject) => {
      probe.#socket.once('open', resolve);
      probe.#socket.once('error', reject);
    });
    probe.#socket.send(JSON.stringify({ type: 'hello', token, version: 1, epoch: 0, seq: 0 }));
    return probe;
  }

  #take({ type, part, reset, set = {}, del = [] }) {
    if (type !== 'delta') return;
    const table = reset ? {} : (this.tables[part] ?? {});
    Object.assign(table, set);
    for (const id of del) delete table[id];
    this.tables[part] = table;
  }

  /** Waits until `find(tables)` gives something. */
  async until(find, ms = 30_000) {
    for (const end = Date.now() + ms; Date.now() < end; ) {
      const found = find(this.tables);
      if (found) return found;
      await new Promise((resolve) => setTimeout(resolve, 100));
    }
    throw new Error('the server never told what was waited for');
  }

  close() {
    this.#socket.terminate();
  }
}
