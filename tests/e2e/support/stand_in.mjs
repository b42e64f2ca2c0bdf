// web/dev/fake_server.mjs: the protocol with an invented world in which every mode has something to show.
import { spawn } from 'node:child_process';
import { fileURLToPath } from 'node:url';

export class StandIn {
  url = '';
  #child;

  async start(env = {}) {
    const script = fileURLToPath(new URL('../../../web/dev/fake_server.mjs', import.meta.url));
    this.#child = spawn(process.execPath, [script, '0'], { stdio: ['ignore', 'pipe', 'inherit'], env: { ...process.env, ...env } });
    this.url = await new Promise((resolve, reject) => {
      this.#child.stdout.on('data', (text) => resolve(/http:\S+/.exec(text)[0]));
      this.#child.once('exit', () => reject(new Error('the stand-in did not start')));
    });
    return this;
  }

  stop() {
    this.#child?.kill();
  }
}
