/**
 * What the service worker does with a request, apart from the worker itself so that it is tested without one. The page is
 * asked of the server first, so that a new version is seen at once; its files carry a hash in their names and never change;
 * pictures of plans are kept for the time without a link. Everything else (the live link, commands) is none of its business.
 */
export type Way = 'page' | 'file' | 'picture' | 'pass';

const kPicture = /^\/api\/plans\/[^/]+\/(picture|rectified)$/;
/** A server that takes longer is treated as away: a tablet in the field must show something. */
const kPatienceMs = 3_000;
const kPicturesKept = 8;

export type Asked = Pick<Request, 'method' | 'url' | 'mode'>;

export function wayOf({ method, url, mode }: Asked, origin: string, files: ReadonlySet<string>): Way {
  const { origin: from, pathname } = new URL(url);
  if (method !== 'GET' || from !== origin) return 'pass';
  if (mode === 'navigate') return 'page';
  if (files.has(pathname)) return 'file';
  return kPicture.test(pathname) ? 'picture' : 'pass';
}

export interface Means {
  readonly shell: Cache;
  readonly pictures: Cache;
  readonly fetch: (request: Request) => Promise<Response>;
  readonly after: (ms: number) => Promise<void>;
}

export function answer(way: Exclude<Way, 'pass'>, request: Request, means: Means): Promise<Response> {
  if (way === 'page') return page(request, means);
  return way === 'file' ? file(request, means) : picture(request, means);
}

/** Any address of the app is the same page. */
async function page(request: Request, { shell, fetch, after }: Means): Promise<Response> {
  const late = after(kPatienceMs).then(() => undefined);
  const fresh = await Promise.race([fetch(request).catch(() => undefined), late]);
  if (fresh?.ok) return fresh;
  return (await shell.match('/')) ?? fresh ?? Response.error();
}

async function file(request: Request, { shell, fetch }: Means): Promise<Response> {
  return (await shell.match(request)) ?? fetch(request);
}

async function picture(request: Request, { pictures, fetch }: Means): Promise<Response> {
  const fresh = await fetch(request).catch(() => undefined);
  if (fresh?.ok) {
    await pictures.put(request, fresh.clone());
    const kept = await pictures.keys();
    await Promise.all(kept.slice(0, Math.max(0, kept.length - kPicturesKept)).map((oldest) => pictures.delete(oldest)));
    return fresh;
  }
  return (await pictures.match(request)) ?? fresh ?? Response.error();
}
