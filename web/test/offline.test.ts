import { describe, expect, test } from 'vitest';
import { answer, type Means, wayOf } from '../src/offline/strategy';

const kOrigin = 'https://smokemap.local';
const files = new Set(['/', '/assets/index-1.js', '/icon.svg']);
const asked = (path: string, options: { method?: string; mode?: RequestMode } = {}) => ({
  url: path.startsWith('http') ? path : `${kOrigin}${path}`,
  method: options.method ?? 'GET',
  mode: options.mode ?? 'cors',
});

/** As much of a Cache as is used, in memory. */
class FakeCache {
  readonly kept = new Map<string, Response>();
  match(request: RequestInfo): Promise<Response | undefined> {
    return Promise.resolve(this.kept.get(this.#key(request))?.clone());
  }
  put(request: RequestInfo, response: Response): Promise<void> {
    this.kept.set(this.#key(request), response);
    return Promise.resolve();
  }
  keys(): Promise<Request[]> {
    return Promise.resolve([...this.kept.keys()].map((url) => new Request(url)));
  }
  delete(request: RequestInfo): Promise<boolean> {
    return Promise.resolve(this.kept.delete(this.#key(request)));
  }
  #key(request: RequestInfo): string {
    return new URL(typeof request === 'string' ? request : request.url, kOrigin).href;
  }
}

function surroundings(network: (request: Request) => Promise<Response>) {
  const shell = new FakeCache();
  const pictures = new FakeCache();
  void shell.put('/', new Response('kept page'));
  void shell.put('/assets/index-1.js', new Response('kept script'));
  let late: () => void = () => {};
  let calls = 0;
  const fetcher = (request: Request): Promise<Response> => {
    calls++;
    return network(request);
  };
  const means: Means = {
    shell: shell as unknown as Cache,
    pictures: pictures as unknown as Cache,
    fetch: fetcher,
    after: () => new Promise((resolve) => (late = resolve)),
  };
  return { means, pictures, runLate: () => late(), calls: () => calls };
}
const request = (path: string): Request => new Request(`${kOrigin}${path}`);
const gone = (): Promise<Response> => Promise.reject(new TypeError('no network'));
const says = (text: string, status = 200) => (): Promise<Response> => Promise.resolve(new Response(text, { status }));
const textOf = async (response: Promise<Response>): Promise<string> => (await response).text();

describe('what the service worker answers', () => {
  test('pages, files of the page and pictures of plans; nothing else', () => {
    const way = (path: string, options?: Parameters<typeof asked>[1]) => wayOf(asked(path, options), kOrigin, files);
    expect(way('/review', { mode: 'navigate' })).toBe('page');
    expect(way('/assets/index-1.js')).toBe('file');
    expect(way('/api/plans/abc/rectified?v=7')).toBe('picture');
    expect(way('/api/plans/abc/picture')).toBe('picture');
    for (const path of ['/api/plans/abc/read', '/api/me', '/api/events', '/assets/unknown.js', 'https://elsewhere.example/']) expect(way(path)).toBe('pass');
    expect(way('/api/plans/abc/picture', { method: 'POST' })).toBe('pass');
    expect(way('https://elsewhere.example/', { mode: 'navigate' })).toBe('pass');
  });
});

describe('the page itself', () => {
  test('comes from the server while there is one, so that a new version is seen at once', async () => {
    const { means } = surroundings(says('new page'));
    expect(await textOf(answer('page', request('/'), means))).toBe('new page');
  });
  test('comes from the device when the server is away, broken, or too slow', async () => {
    expect(await textOf(answer('page', request('/match'), surroundings(gone).means))).toBe('kept page');
    expect(await textOf(answer('page', request('/'), surroundings(says('no', 502)).means))).toBe('kept page');
    const slow = surroundings(() => new Promise(() => {}));
    const waiting = textOf(answer('page', request('/'), slow.means));
    slow.runLate();
    expect(await waiting).toBe('kept page');
  });
});

describe('files of the page', () => {
  test('are never asked for again: another content has another name', async () => {
    const { means, calls } = surroundings(says('other'));
    expect(await textOf(answer('file', request('/assets/index-1.js'), means))).toBe('kept script');
    expect(calls()).toBe(0);
  });
  test('that are missing come from the server', async () => {
    const { means } = surroundings(says('fresh'));
    expect(await textOf(answer('file', request('/icon.svg'), means))).toBe('fresh');
  });
});

describe('pictures of plans', () => {
  test('are kept for the time without a link', async () => {
    let network = says('picture');
    const { means } = surroundings(() => network());
    await answer('picture', request('/api/plans/a/picture'), means);
    network = gone;
    expect(await textOf(answer('picture', request('/api/plans/a/picture'), means))).toBe('picture');
  });
  test('a refusal is not kept, and is told when nothing is known', async () => {
    const { means, pictures } = surroundings(says('who are you', 401));
    expect((await answer('picture', request('/api/plans/a/picture'), means)).status).toBe(401);
    expect(pictures.kept.size).toBe(0);
  });
  test('only the latest eight take room on the device', async () => {
    const { means, pictures } = surroundings(says('picture'));
    for (let i = 0; i < 12; i++) await answer('picture', request(`/api/plans/p${i}/picture`), means);
    expect([...pictures.kept.keys()].map((url) => /p(\d+)/.exec(url)![1])).toEqual(['4', '5', '6', '7', '8', '9', '10', '11']);
  });
});
