/** Keeps the page for the time without a link. The build puts the list of its files here (build/service_worker.ts). */
import { answer, wayOf } from './strategy';

declare const __SMOKEMAP_FILES__: readonly string[];
declare const __SMOKEMAP_VERSION__: string;

interface LifeEvent extends Event {
  waitUntil(work: Promise<unknown>): void;
}
interface AskEvent extends LifeEvent {
  readonly request: Request;
  respondWith(response: Promise<Response>): void;
}
interface WorkerScope {
  readonly clients: { claim(): Promise<void> };
  skipWaiting(): Promise<void>;
  addEventListener(name: 'install' | 'activate', listener: (event: LifeEvent) => void): void;
  addEventListener(name: 'fetch', listener: (event: AskEvent) => void): void;
}

const scope = self as unknown as WorkerScope;
const kShell = `smokemap-page-${__SMOKEMAP_VERSION__}`;
const kPictures = 'smokemap-pictures';
const files: ReadonlySet<string> = new Set(__SMOKEMAP_FILES__);

async function install(): Promise<void> {
  const shell = await caches.open(kShell);
  await shell.addAll([...files].map((file) => new Request(file, { cache: 'no-cache' })));
  await scope.skipWaiting();
}

async function activate(): Promise<void> {
  const old = (await caches.keys()).filter((name) => name.startsWith('smokemap-page-') && name !== kShell);
  await Promise.all(old.map((name) => caches.delete(name)));
  await scope.clients.claim();
}

scope.addEventListener('install', (event) => event.waitUntil(install()));
scope.addEventListener('activate', (event) => event.waitUntil(activate()));
scope.addEventListener('fetch', (event) => {
  const way = wayOf(event.request, location.origin, files);
  if (way === 'pass') return;
  const means = async () => ({
    shell: await caches.open(kShell),
    pictures: await caches.open(kPictures),
    fetch: (request: Request) => fetch(request),
    after: (ms: number) => new Promise<void>((resolve) => setTimeout(resolve, ms)),
  });
  event.respondWith(means().then((ready) => answer(way, event.request, ready)));
});
