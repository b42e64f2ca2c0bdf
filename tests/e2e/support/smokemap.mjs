// Starts the real server with the demo on a free port, a data folder and a ROS domain of its own; ends it as a power cut would.
import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = fileURLToPath(new URL('../../../', import.meta.url));
const kStartMs = 60_000;

function findProgram() {
  const places = [process.env.SMOKEMAP_PROGRAM, ...['ci', 'release', 'dev'].map((preset) => join(root, 'build', preset, 'engine/app/smokemap'))];
  const found = places.find((place) => place && existsSync(place));
  if (!found) throw new Error('smokemap is not built: ./run --build-only builds it');
  return found;
}

export class Smokemap {
  folder = mkdtempSync(join(tmpdir(), 'smokemap-e2e-'));
  #domain = 1 + (process.pid % 200);
  #child = null;
  #port = 0;
  #output = '';
  url = '';

  /** Resolves when the address is known. A second start takes the same port and data. */
  async start() {
    const args = ['serve', '--demo', '--data', this.folder, '--web', join(root, 'web/dist'), '--port', String(this.#port), '--ros-domain', String(this.#domain)];
    this.#output = '';
    this.#child = spawn(findProgram(), args, { stdio: ['ignore', 'pipe', 'pipe'] });
    this.#child.stdout.on('data', (text) => (this.#output += text));
    this.#child.stderr.on('data', (text) => (this.#output += text));
    const until = Date.now() + kStartMs;
    for (;;) {
      const address = /http:\/\/[\w.:[\]]+\//.exec(this.#output)?.[0];
      if (address) {
        this.url = address;
        this.#port = Number(new URL(address).port);
        return this;
      }
      if (this.#child.exitCode !== null || Date.now() > until) throw new Error(`smokemap did not start:\n${this.#output}`);
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
  }

  signal(name) {
    this.#child?.kill(name);
  }

  /** SIGKILL: no time to tidy up. */
  async kill() {
    const child = this.#child;
    this.#child = null;
    if (!child || child.exitCode !== null) return;
    await new Promise((resolve) => {
      child.once('exit', resolve);
      child.kill('SIGKILL');
    });
  }

  async dispose() {
    await this.kill();
    rmSync(this.folder, { recursive: true, force: true });
  }
}
