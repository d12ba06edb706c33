/** What the web endpoint answers to requests that no browser makes, or only a hostile one. */
import assert from 'node:assert/strict';
import { randomBytes } from 'node:crypto';
import { existsSync } from 'node:fs';
import { request } from 'node:http';
import { connect } from 'node:net';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { eventually, startServer } from './server.mjs';

let server;
let host;
let port;
before(async () => {
  server = await startServer({ play: 'sandbox', pile: 'pyramid:base=4' });
  ({ hostname: host, port } = new URL(server.url));
});
after(async () => {
  const status = await server?.stop();
  server?.forget();
  assert.equal(status, 0, 'the server ends well after all of this');
});

/** Sends the path as it stands, which `fetch` would tidy up. */
function get(path, { method = 'GET', headers = {} } = {}) {
  return new Promise((done, fail) => {
    const asked = request({ host, port, path, method, headers, agent: false }, (reply) => {
      const parts = [];
      reply.on('data', (part) => parts.push(part));
      reply.on('end', () =>
        done({
          status: reply.statusCode,
          headers: reply.headers,
          body: Buffer.concat(parts).toString(),
        }),
      );
    });
    asked.on('error', fail);
    asked.end();
  });
}

/** The status of an attempt to watch, and the socket if it is a WebSocket now. */
function watch(path, headers = {}) {
  return new Promise((done, fail) => {
    const asked = request({
      host,
      port,
      path,
      agent: false,
      headers: {
        Connection: 'Upgrade',
        Upgrade: 'websocket',
        'Sec-WebSocket-Version': '13',
        'Sec-WebSocket-Key': randomBytes(16).toString('base64'),
        ...headers,
      },
    });
    asked.on('upgrade', (reply, socket) => {
      socket.on('error', () => {});
      done({ status: reply.statusCode, socket });
    });
    asked.on('response', (reply) => {
      reply.resume();
      done({ status: reply.statusCode });
    });
    asked.on('error', fail);
    asked.end();
  });
}

/** A masked frame of a WebSocket's client. */
function masked(opcode, bytes) {
  const mask = randomBytes(4);
  const length =
    bytes.length < 126
      ? [0x80 | bytes.length]
      : [0x80 | 126, bytes.length >> 8, bytes.length & 255];
  return Buffer.concat([
    Buffer.from([0x80 | opcode, ...length]),
    mask,
    bytes.map((b, i) => b ^ mask[i & 3]),
  ]);
}

test('bad addresses give 404, and no path leads to a file', async () => {
  for (const path of [
    '/nothing',
    '/main.js/',
    '/../../etc/passwd',
    '/%2e%2e/%2e%2e/etc/passwd',
    '//etc/passwd',
    '/index.html',
    '/message.html',
    '/?session=none',
    '/?session=',
    `/?session=${'a'.repeat(1000)}`,
    '/?session=../play',
    '/?session=%3Cscript%3E',
  ]) {
    const reply = await get(path);
    assert.ok([400, 403, 404].includes(reply.status), `${path}: ${reply.status}`);
    assert.doesNotMatch(reply.body, /root:|<script/, path);
  }
  assert.equal((await get('/nothing')).status, 404);
  assert.equal((await get('/?session=none')).status, 404);
  await assert.rejects(get('/main.js%00'), /hang up|ECONNRESET/, 'a zero byte ends the connection');
});

test('every reply carries the headers that keep a browser from running anything else', async () => {
  for (const path of [
    '/',
    '/?session=play',
    '/main.js',
    '/style.css',
    '/favicon.svg',
    '/nothing',
  ]) {
    const { headers } = await get(path);
    assert.match(headers['content-security-policy'], /default-src 'none'; script-src 'self'/, path);
    const policy = headers['content-security-policy'].replace("'wasm-unsafe-eval'", '');
    assert.doesNotMatch(policy, /unsafe|\*/, path);
    assert.equal(headers['x-content-type-options'], 'nosniff', path);
  }
  assert.match((await get('/main.js')).headers['content-type'], /^text\/javascript/);
});

test('only GET and HEAD are answered', async () => {
  const head = await get('/?session=play', { method: 'HEAD' });
  assert.equal(head.status, 200);
  assert.equal(head.body, '');
  for (const method of ['POST', 'PUT', 'DELETE', 'PATCH', 'OPTIONS']) {
    const reply = await get('/', { method }).catch(() => ({ status: 'closed' }));
    assert.ok([403, 405, 'closed'].includes(reply.status), `${method}: ${reply.status}`);
  }
});

test('a session is watched from the page of its own server only', async () => {
  assert.equal((await watch('/view?session=none')).status, 404);
  assert.equal((await watch('/view')).status, 404);
  assert.equal((await watch('/elsewhere?session=play')).status, 404);
  assert.equal(
    (await watch('/view?session=play', { Origin: 'http://elsewhere.example' })).status,
    403,
  );
  assert.equal((await get('/view?session=play')).status, 426);
  const own = await watch('/view?session=play', { Origin: `http://${host}:${port}` });
  assert.equal(own.status, 101);
  own.socket.destroy();
});

test('a viewer that sends anything is let go', async () => {
  const small = await watch('/view?session=play');
  const large = await watch('/view?session=play');
  for (const [viewer, bytes] of [
    [small, Buffer.from('hello')],
    [large, randomBytes(60_000)],
  ]) {
    const ended = new Promise((done) => viewer.socket.on('close', done));
    viewer.socket.resume();
    viewer.socket.write(masked(2, bytes));
    await ended;
  }
});

/** The bytes of messages that a server sends over a WebSocket, until it closes. */
function heard(socket) {
  return new Promise((done) => {
    const parts = [];
    socket.on('data', (part) => parts.push(part));
    socket.on('close', () => done(Buffer.concat(parts)));
  });
}

test('a page that steps the world itself comes in by a door of its own', async () => {
  assert.equal((await get('/peer')).status, 426);
  assert.equal((await watch('/peer', { Origin: 'http://elsewhere.example' })).status, 403);
  const own = await watch('/peer', { Origin: `http://${host}:${port}` });
  assert.equal(own.status, 101);
  const words = heard(own.socket);
  own.socket.write(masked(2, randomBytes(300)));
  const said = await words;
  // A frame of the protocol with a Bye, and then the end.
  const start = said[1] < 126 ? 2 : 4;
  assert.equal(said.readUInt16LE(start), 0x4875);
  assert.equal(said[start + 3], 12, 'a Bye');
  assert.match(said.toString('latin1'), /no frame starts here/);
});

test('a page that says nothing is let go, and takes nobody any place', { timeout: 30_000 }, async () => {
  const silent = [];
  for (let i = 0; i < 20; ++i) silent.push((await watch('/peer')).socket);
  const since = Date.now();
  const last = await Promise.all(silent.map(heard));
  const seconds = (Date.now() - since) / 1000;
  assert.ok(seconds > 3 && seconds < 15, `${seconds} s`);
  for (const said of last) assert.match(said.toString('latin1'), /no Hello in time/);
});

test('the core for browsers comes packed, in both forms, or not at all', async () => {
  const sizes = [];
  for (const name of ['core.wasm', 'core_simd.wasm']) {
    const { status, headers } = await get(`/${name}`);
    if (status === 404) continue;
    assert.equal(headers['content-type'], 'application/wasm');
    assert.equal(headers['content-encoding'], 'gzip');
    const module = await (await fetch(`http://${host}:${port}/${name}`)).arrayBuffer();
    assert.deepEqual(WebAssembly.Module.imports(new WebAssembly.Module(module)), []);
    assert.ok(Number(headers['content-length']) < module.byteLength / 2);
    sizes.push(module.byteLength);
  }
  const there = existsSync(join(process.env.HUESTEP_WASM ?? 'none', 'huestep.wasm'));
  assert.equal(sizes.length, there ? 2 : 0);
});

test('the number of viewers has a cap, and places become free again', async () => {
  const sockets = [];
  let refused = 0;
  for (let i = 0; i < 70; ++i) {
    // Of either kind.
    const { status, socket } = await watch(i % 2 ? '/view?session=pile' : '/peer');
    if (socket) sockets.push(socket);
    else assert.ok(status === 503, `status ${status}`);
    refused += socket ? 0 : 1;
  }
  assert.equal(sockets.length, 64);
  assert.equal(refused, 6);
  for (const socket of sockets) socket.destroy();
  const again = await eventually(
    'a free place',
    async () => (await watch('/view?session=pile')).socket,
  );
  again.destroy();
});

test('bytes that are no HTTP, and heads that never end, leave the server as it was', async () => {
  const say = (bytes) =>
    new Promise((done) => {
      const socket = connect({ host, port: Number(port) }, () => socket.write(bytes));
      socket.on('error', () => {});
      socket.on('close', done);
      socket.resume();
      setTimeout(() => socket.destroy(), 300);
    });
  await Promise.all([
    say(randomBytes(2000)),
    say('GET '),
    say(`GET /${'a'.repeat(20_000)} HTTP/1.1\r\n\r\n`),
    say(`GET / HTTP/1.1\r\n${'X-Header: y\r\n'.repeat(2000)}\r\n`),
    say('PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n'),
    say(
      'GET / HTTP/1.1\r\nConnection: Upgrade, HTTP2-Settings\r\n' +
        'Upgrade: h2c\r\nHTTP2-Settings: AAMAAABk\r\n\r\n',
    ),
  ]);
  assert.equal((await get('/main.js')).status, 200);
});

test('too many requests are answered with 429, and later ones again with the page', async () => {
  let status = 200;
  for (let i = 0; i < 2000 && status !== 429; ++i) ({ status } = await get('/favicon.svg'));
  assert.equal(status, 429);
  await eventually('a page again', async () => (await get('/favicon.svg')).status === 200);
});
