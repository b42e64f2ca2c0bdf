/** The HTTP side of the server. Every call gives a value or a line for people; nothing throws. */
import type { Command } from '../wire/commands';
import * as http from '../wire/http';
import { type LayoutDocument, parseReadAnswer } from '../wire/layout_document';
import type { Role } from '../wire/parts';

export type Answer<T> = { readonly ok: true; readonly value: T } | { readonly ok: false; readonly message: string; readonly status: number };

const failed = (message: string, status = 0): { ok: false; message: string; status: number } => ({ ok: false, message, status });

export class Api {
  readonly #fetch: typeof fetch;
  token = '';

  constructor(fetcher: typeof fetch = (...args) => fetch(...args)) {
    this.#fetch = fetcher;
  }

  pair(name: string, role: Role, pin: string): Promise<Answer<http.Pairing>> {
    const body = JSON.stringify({ name, role, ...(pin ? { pin } : {}) });
    return this.#json('POST', '/api/pair', http.parsePairing, body, 'application/json');
  }

  /** @param patient a page of a PDF that takes over a second to draw is waited for instead of refused (413) */
  uploadPlan(file: Blob, page = 1, patient = false): Promise<Answer<http.Upload>> {
    const query = file.type === 'application/pdf' ? `?page=${page}${patient ? '&patience=1' : ''}` : '';
    return this.#json('POST', `/api/plans${query}`, http.parseUpload, file, file.type);
  }

  readPlan(
    planId: string,
    options: { corners?: readonly (readonly [number, number])[]; metres_per_pixel?: number; plan_at?: readonly [number, number] },
  ): Promise<Answer<{ layout: LayoutDocument; rectified: string }>> {
    const path = `/api/plans/${encodeURIComponent(planId)}/read`;
    return this.#json('POST', path, parseReadAnswer, JSON.stringify(options), 'application/json');
  }

  sketchPhoto(file: Blob): Promise<Answer<http.SketchPhoto>> {
    return this.#json('POST', '/api/sketch-photo', http.parseSketchPhoto, file, file.type);
  }

  /** For commands too large for the socket. Resolves with the number of the event. */
  command(id: string, command: Command): Promise<Answer<{ seq: number }>> {
    const body = JSON.stringify({ type: 'command', id, ...command });
    return this.#json('POST', '/api/commands', http.parseDone, body, 'application/json');
  }

  way(robot: string, [x, y]: readonly [number, number]): Promise<Answer<http.Way>> {
    return this.#json('GET', `/api/way?${new URLSearchParams({ robot, x: x.toFixed(2), y: y.toFixed(2) })}`, http.parseWay);
  }

  events(from: number, limit: number): Promise<Answer<{ events: http.LogEvent[]; next: number | null }>> {
    return this.#json('GET', `/api/events?from=${from}&limit=${limit}`, http.parseEventPage);
  }

  snapshot(at: number): Promise<Answer<Record<string, Record<string, unknown>>>> {
    return this.#json('GET', `/api/snapshot?at=${at}`, http.parseSnapshot);
  }

  /** Pictures and exports need the token, which an <img> or a link cannot carry. */
  async blob(path: string): Promise<Answer<Blob>> {
    const answer = await this.#call('GET', path);
    return answer.ok ? { ok: true, value: await answer.value.blob() } : answer;
  }

  async #json<T>(
    method: string,
    path: string,
    parse: (value: unknown) => T | undefined,
    body?: BodyInit,
    type?: string,
  ): Promise<Answer<T>> {
    const answer = await this.#call(method, path, body, type);
    if (!answer.ok) return answer;
    const value = parse(await answer.value.json().catch(() => undefined));
    return value === undefined ? failed(`the server's answer to ${path.split('?')[0]} was not understood`) : { ok: true, value };
  }

  async #call(method: string, path: string, body?: BodyInit, type?: string): Promise<Answer<Response>> {
    const headers: Record<string, string> = {};
    if (this.token) headers['Authorization'] = `Bearer ${this.token}`;
    if (type) headers['Content-Type'] = type;
    let response: Response;
    try {
      response = await this.#fetch(path, { method, headers, ...(body === undefined ? {} : { body }) });
    } catch {
      return failed('no link to the server');
    }
    if (response.ok) return { ok: true, value: response };
    const said = http.parseFailure(await response.json().catch(() => undefined));
    return failed(said?.error.message ?? `the server answered ${response.status}`, response.status);
  }
}
