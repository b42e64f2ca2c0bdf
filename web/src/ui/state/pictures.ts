/** Pictures of the server, decoded once. They need the token, so they are fetched, not linked. */
import type { Api } from '../../link/api';

const kKept = 6;
const kRetryMs = 10_000;

export class Pictures {
  readonly #api: Api;
  readonly #known = new Map<string, Promise<ImageBitmap | null>>();

  constructor(api: Api) {
    this.#api = api;
  }

  get(url: string): Promise<ImageBitmap | null> {
    const known = this.#known.get(url);
    if (known) return known;
    const loading = this.#load(url);
    this.#known.set(url, loading);
    for (const oldest of this.#known.keys()) {
      if (this.#known.size <= kKept) break;
      this.#known.delete(oldest);
    }
    return loading;
  }

  async #load(url: string): Promise<ImageBitmap | null> {
    const answer = await this.#api.blob(url);
    const picture = answer.ok ? await createImageBitmap(answer.value).catch(() => null) : null;
    // A picture that failed is asked for again, but not with every message that moves the plan.
    if (!picture) setTimeout(() => this.#known.delete(url), kRetryMs);
    return picture;
  }
}
