/** Starts and stops the program under test; every process started here ends here. */
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

export const huestep = process.env.HUESTEP ?? 'build/release/huestep';

/** Waits for `check()` to give something; the sentence says what did not come. */
export async function eventually(what, check, seconds = 60) {
  const until = Date.now() + 1000 * seconds;
  for (;;) {
    const found = await check();
    if (found) return found;
    if (Date.now() > until) throw new Error(`waited ${seconds} s for ${what}`);
    await new Promise((done) => setTimeout(done, 50));
  }
}

class Program {
  constructor(...words) {
    this.output = '';
    this.errors = '';
    this.status = null;
    this.child = spawn(huestep, words, { stdio: ['ignore', 'pipe', 'pipe'] });
    this.child.stdout.on('data', (text) => {
      this.output += text;
    });
    this.child.stderr.on('data', (text) => {
      this.errors += text;
    });
    this.ended = new Promise((done) =>
      this.child.on('close', (status, signal) => {
        this.status = signal ?? status;
        done(this.status);
      }),
    );
  }

  /** Asks it to end; its exit status. */
  async stop() {
    if (this.status === null) this.child.kill('SIGTERM');
    const late = setTimeout(() => this.child.kill('SIGKILL'), 20_000);
    await this.ended;
    clearTimeout(late);
    return this.status;
  }
}

/**
 * A server with a page.
 * @param {Record<string, string>} sessions name to scene
 * @param {{data?: string, web?: string, door?: string[]}} where to go on from an earlier server's,
 *   and who may come in: anyone, unless said
 */
export async function startServer(sessions, where = {}) {
  const data = where.data ?? mkdtempSync(join(tmpdir(), 'huestep-browser-'));
  const named = Object.entries(sessions).flatMap(([name, scene]) => [
    '--session',
    `${name}=${scene}`,
  ]);
  const program = new Program(
    'serve',
    '--listen',
    '127.0.0.1:0',
    '--web',
    where.web ?? '127.0.0.1:0',
    '--data',
    data,
    ...(where.door ?? ['--open']),
    ...named,
  );
  const bots = [];
  const line = (pattern) => () => {
    if (program.status !== null) throw new Error(`the server ended: ${program.errors}`);
    return program.output.match(pattern)?.[1];
  };
  try {
    const url = await eventually('the address of the page', line(/^page (http:\S+)$/m));
    const address = await eventually('the address of the server', line(/^listening on (\S+)$/m));
    return {
      url,
      address,
      data,
      log: () => program.errors,
      /** Lets bots play in a session. */
      play(session, count) {
        for (let i = 0; i < count; ++i) {
          bots.push(new Program('join', address, '--session', session, '--bot', 'wander'));
        }
      },
      /** Holds the server still, its connections open, until `wake`. */
      sleep: () => program.child.kill('SIGSTOP'),
      wake: () => program.child.kill('SIGCONT'),
      /** The server's exit status; all its bots are gone too. */
      async stop() {
        await Promise.all(bots.map((bot) => bot.stop()));
        return program.stop();
      },
      forget: () => rmSync(data, { recursive: true, force: true }),
    };
  } catch (problem) {
    await program.stop();
    throw problem;
  }
}

/** A server and what is done with it; the server ends whatever happens, and must end well. */
export async function withServer(sessions, body, where = {}) {
  const server = await startServer(sessions, where);
  try {
    await body(server);
    assert.equal(await server.stop(), 0, server.log());
  } finally {
    await server.stop();
    server.forget();
  }
}

/** What a subcommand answers in JSON. */
export function ask(...words) {
  const { status, stdout, stderr } = spawnSync(huestep, [...words, '--json'], {
    encoding: 'utf8',
    maxBuffer: 1 << 28,
  });
  if (status !== 0) throw new Error(`huestep ${words.join(' ')}: ${stderr}`);
  return JSON.parse(stdout);
}
