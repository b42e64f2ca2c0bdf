/** The way that a robot would take to a place, asked for again and again while somebody thinks about sending it there. */
import type { MapPoint } from '../../geometry/points';
import type { Api } from '../../link/api';
import type { Way } from '../../wire/http';

const kAgainMs = 2_000;

export class WayAhead {
  /** What the server says now; nothing before its first answer, and while the link is away. */
  way = $state.raw<Way | undefined>();
  readonly #api: Api;
  #asked = 0;

  constructor(api: Api) {
    this.#api = api;
  }

  /** Returns how to stop; until then `way` is kept new. */
  follow(robot: string, p: MapPoint): () => void {
    const ask = (): void => void this.#ask(robot, p);
    ask();
    const timer = setInterval(ask, kAgainMs);
    return () => {
      clearInterval(timer);
      this.#asked++;
      this.way = undefined;
    };
  }

  async #ask(robot: string, p: MapPoint): Promise<void> {
    const turn = ++this.#asked;
    const answer = await this.#api.way(robot, p);
    if (turn === this.#asked) this.way = answer.ok ? answer.value : undefined;
  }
}
