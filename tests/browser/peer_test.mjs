/**
 * The page's peer in node: the same modules and the same scripts, over TCP against a real server
 * that native bots play on.
 */
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { copyFileSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { connect } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { ask, eventually, huestep, withServer } from './server.mjs';

const root = process.env.HUESTEP_SOURCE ?? fileURLToPath(new URL('../..', import.meta.url));
const modules = process.env.HUESTEP_WASM ?? 'build/release/wasm';

// What the scripts take from a browser.
globalThis.window = globalThis;
globalThis.WebSocket = { OPEN: 1 };

// Copies, since the page's files have no package.json by which they would count as modules here.
const scripts = mkdtempSync(join(tmpdir(), 'huestep-page-'));
after(() => rmSync(scripts, { recursive: true, force: true }));
writeFileSync(join(scripts, 'package.json'), '{"type": "module"}');
const scriptOf = (name) => {
  copyFileSync(join(root, 'client/web', name), join(scripts, name));
  return pathToFileURL(join(scripts, name)).href;
};
const { Core, CoreError } = await import(scriptOf('core.js'));
const { Peer } = await import(scriptOf('peer.js'));
const viewer = await import(scriptOf('view.js'));

const compiled = (name) => new WebAssembly.Module(readFileSync(join(modules, name)));
const forms = { 'with SIMD': compiled('huestep_simd.wasm'), 'without SIMD': compiled('huestep.wasm') };

/** A peer on a TCP connection of its own, and what it told. */
function enterSession(server, module, session, role = 'spectator', ticket = '') {
  const core = new Core(new WebAssembly.Instance(module));
  const told = { history: [], views: 0, view: null, differences: [], failed: [], numbers: null };
  const peer = new Peer(core, session, role, {
    stepped: (numbers) => {
      told.numbers = numbers;
      told.history.push({ tick: numbers.tick, root: numbers.root });
    },
    view: (frame) => {
      told.views += 1;
      const view = viewer.readFrame(frame);
      if (!view.shapes && told.view?.definitions === view.definitions) view.shapes = told.view.shapes;
      told.view = view;
    },
    differed: (sentence) => told.differences.push(sentence),
    failed: (sentence) => told.failed.push(sentence),
    stopped: (sentence) => told.failed.push(`the core stopped: ${sentence}`),
  }, ticket);
  const [host, port] = server.address.split(':');
  const line = {
    open() {
      const socket = connect({ host, port });
      this.socket = socket;
      socket.on('connect', () =>
        peer.connected({ readyState: 1, send: (bytes) => socket.write(bytes) }),
      );
      socket.on('data', (bytes) => {
        if (this.socket === socket) peer.receive(new Uint8Array(bytes).buffer);
      });
      socket.on('error', () => {});
    },
    close() {
      peer.disconnected();
      this.socket.destroy();
      this.socket = null;
    },
  };
  line.open();
  return { peer, told, line };
}

const withPeers = (sessions, body, where = {}) =>
  withServer(sessions, async (server) => {
    const lines = [];
    try {
      await body(server, (...how) => {
        const joined = enterSession(server, ...how);
        lines.push(joined.line);
        return joined;
      });
    } finally {
      for (const line of lines) if (line.socket) line.close();
    }
  }, where);

for (const [form, module] of Object.entries(forms)) {
  test(`${form}: a spectator that comes late steps what bots play, every hash the server's`, () =>
    withPeers({ play: 'sandbox' }, async (server, enter) => {
      server.play('play', 3);
      await new Promise((done) => setTimeout(done, 1500));
      const { told } = enter(module, 'play');
      await eventually('300 ticks', () => told.history.length > 300);
      assert.deepEqual(told.failed, []);
      assert.deepEqual(told.differences, []);
      assert.ok(told.history[0].tick > 30, `it came late, at tick ${told.history[0].tick}`);
      assert.equal(told.numbers.mismatches, 0);
      assert.equal(told.numbers.snapshots, 1);
      // One hash a frame; the first world came by snapshot, and is compared with the next frame.
      assert.equal(told.numbers.hashesCompared, told.numbers.ticks);
      assert.ok(told.numbers.hashesCompared >= 300);
      told.history.forEach(({ tick }, i) => assert.equal(tick, told.history[0].tick + i));
      assert.equal(told.view.tick, told.numbers.tick);
      assert.equal(told.view.root, told.numbers.root);
      assert.equal(told.view.players, 3);
      assert.ok(told.view.shapes.count > 30);
      await server.stop();
      for (const seen of [told.history[0], told.history.at(-1)]) {
        const replay = ask('replay', join(server.data, 'play'), '--to', String(seen.tick));
        assert.equal(replay.hash.motion, seen.root, `motion root after tick ${seen.tick}`);
      }
    }));
}

const module = forms['with SIMD'];

test('a flipped bit is found in the next tick, named, and mended', () =>
  withPeers({ pile: 'pyramid:base=12' }, async (server, enter) => {
    const { peer, told } = enter(module, 'pile');
    await eventually('30 ticks', () => told.history.length > 30);
    const motions = peer.motions();
    const bits = new Uint32Array(motions.buffer, motions.byteOffset, motions.length);
    const flipped = { tick: told.numbers.tick, at: performance.now() };
    bits[8 * 17 + 4] ^= 1; // the lowest bit of the velocity of the eighteenth body
    await eventually('the difference', () => told.differences.length > 0);
    const seconds = (performance.now() - flipped.at) / 1000;
    assert.ok(seconds < 1, `named after ${seconds} s`);
    const { bodies } = ask('run', 'pyramid:base=12', '--ticks', '1');
    assert.ok(bodies > 18);
    const words = told.differences[0].match(
      /^tick (\d+): body (\d+) velocity\.x (\S+) here, (\S+) at the server$/,
    );
    assert.ok(words, told.differences[0]);
    assert.equal(Number(words[1]), flipped.tick);
    assert.equal(Number(words[2]), 18);
    const apart = Math.abs(Number(words[3]) - Number(words[4]));
    assert.ok(apart > 0 && apart < 1e-6, `${words[3]} and ${words[4]}`);
    const { ticks } = told.numbers;
    await eventually('agreement again', () => told.numbers.ticks > ticks + 60);
    assert.equal(told.numbers.mismatches, 1);
    assert.equal(told.numbers.corrections, 1);
    assert.equal(told.differences.length, 1);
    assert.match(server.log(), new RegExp(`desync.*body=${words[2]}.*velocity\\.x`));
  }));

test('a player of the page drags a body, and keeps its seat over a lost connection', () =>
  withPeers({ play: 'sandbox' }, async (server, enter) => {
    const { peer, told, line } = enter(module, 'play', 'player');
    await eventually('60 ticks', () => told.history.length > 60);
    const { player } = told.numbers;
    assert.ok(player > 0, `it is player ${player}`);
    assert.equal(told.view.players, 1);
    const held = peer.ownBody();
    assert.ok(told.view.flags[held] & 8, `body ${held} is a player's`);
    const { joints: without } = told.view;
    assert.ok(peer.grab(...told.view.poses.slice(4 * held, 4 * held + 2)));
    await eventually('the grab', () => told.view.joints.length > without.length);
    const joints = told.view.joints.length / 4;
    const lifted = told.view.poses[4 * held + 1] + 3;
    peer.moveGrab(told.view.poses[4 * held], lifted);
    await eventually('it is drawn there', () => told.view.poses[4 * held + 1] > lifted - 1);
    assert.equal(peer.grab(1e6, 1e6), false, 'there is nothing');
    line.close();
    line.open();
    await eventually('it is back', () => told.numbers.resumes === 1 && told.numbers.ticks > 120);
    assert.equal(told.numbers.player, player);
    assert.ok(peer.release());
    await eventually('the release', () => told.view.joints.length / 4 === joints - 1);
    assert.equal(told.numbers.mismatches, 0);
    assert.deepEqual(told.failed, []);
  }));

test('a peer shows its ticket where the server asks for one, once', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'huestep-ticket-'));
  const run = (...words) => {
    const { status, stdout, stderr } = spawnSync(huestep, words, { encoding: 'utf8' });
    assert.equal(status, 0, stderr);
    return stdout.trim();
  };
  try {
    const club = join(folder, 'club');
    run('ticket', 'key', club);
    const body = async (server, enter) => {
      const issuer = `${club}.issuer.key`;
      const ticket = run('ticket', 'issue', '--key', issuer, '--session', 'play', '--player', 'ann');
      const module = forms['with SIMD'];
      const { told } = enter(module, 'play', 'player', ticket);
      await eventually('20 ticks', () => told.history.length > 20);
      assert.deepEqual(told.failed, []);
      assert.ok(told.numbers.player > 0);
      for (const [shown, why] of [
        [ticket, /used already/],
        ['', /asks for a ticket/],
        ['no ticket!', /no issuer/],
      ]) {
        const other = enter(module, 'play', 'player', shown).told;
        await eventually('a refusal', () => other.failed.length > 0);
        assert.match(other.failed[0], why);
      }
    };
    await withPeers({ play: 'sandbox' }, body, { door: ['--tickets', `${club}.host.key`] });
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
});

test('bytes that are no messages end the connection with a sentence', () =>
  withPeers({ pile: 'pyramid:base=3' }, async (server, enter) => {
    const { peer, told, line } = enter(module, 'pile');
    await eventually('10 ticks', () => told.history.length > 10);
    peer.receive(new Uint8Array(64).fill(7).buffer);
    assert.match(told.failed[0], /no frame starts here/);
    line.close();
    const unknown = enter(module, 'nowhere');
    await eventually('the refusal', () => unknown.told.failed.length > 0);
    assert.match(unknown.told.failed[0], /session/);
  }));

test('what the core cannot hold is said, and a core that stopped as well', () => {
  const core = new Core(new WebAssembly.Instance(module));
  assert.equal(core.lanes, 4);
  assert.throws(() => core.put({ length: 2 ** 30 }), CoreError);
  assert.throws(() => {
    for (;;) core.call('worldOfScene', core.putText('many_pyramids:rows=10,columns=10'), core.why);
  }, /memory|alloc/);
});
