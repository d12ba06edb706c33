/**
 * Whole runs of the core as WebAssembly against the hashes of goldens.txt, which the programs of
 * this machine are held to as well: bit for bit, with and without SIMD instructions.
 *
 * HUESTEP_MODULES names the modules of golden_module.cpp, and the one that a page loads.
 */
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const modules = process.env.HUESTEP_MODULES;
assert.ok(modules, 'HUESTEP_MODULES is the folder of the modules');

/** scene → key ("tick 60", "asleep from tick") → values */
function readGoldens() {
  const all = new Map();
  let scene = null;
  for (const line of readFileSync(join(here, 'goldens.txt'), 'utf8').split('\n')) {
    if (line.startsWith('scene ')) all.set(line.slice(6), (scene = new Map()));
    const pair = line.match(/^ {2}((?:tick|asleep) [^=]*) = (.*)$/);
    if (pair) scene.set(pair[1], pair[2]);
  }
  return all;
}

const compiled = (name) => new WebAssembly.Module(readFileSync(join(modules, name)));

/** An instance, and texts in and out of it. */
class Core {
  constructor(module) {
    this.call = new WebAssembly.Instance(module).exports;
    this.call._initialize();
    this.why = this.call.bytesNew(0);
  }

  bytes(content) {
    const { call } = this;
    const bytes = call.bytesNew(content.length);
    new Uint8Array(call.memory.buffer, call.bytesAt(bytes), content.length).set(content);
    return bytes;
  }

  text(words) {
    return this.bytes(new TextEncoder().encode(words));
  }

  contentOf(bytes) {
    const { call } = this;
    return new Uint8Array(call.memory.buffer, call.bytesAt(bytes), call.bytesSize(bytes)).slice();
  }

  sentence() {
    return new TextDecoder().decode(this.contentOf(this.why));
  }

  worldOf(scene) {
    const world = this.call.worldOfScene(this.text(scene), this.why);
    assert.notEqual(world, 0, this.sentence());
    return world;
  }

  roots(world) {
    const hex = (root) => BigInt.asUintN(64, root).toString(16).padStart(16, '0');
    return `${hex(this.call.worldFullRoot(world))} ${hex(this.call.worldMotionRoot(world))}`;
  }
}

const goldens = readGoldens();
assert.ok(goldens.size > 10, `${goldens.size} golden runs were read`);

test('a module for pages imports nothing', () => {
  for (const name of ['huestep.wasm', 'huestep_simd.wasm']) {
    assert.deepEqual(WebAssembly.Module.imports(compiled(`../${name}`)), [], name);
  }
});

for (const [name, lanes] of [
  ['goldens', 1],
  ['goldens_simd', 4],
]) {
  const module = compiled(`${name}.wasm`);

  test(`${name}: every golden run of goldens.txt is there, and no other`, () => {
    const core = new Core(module);
    assert.equal(core.call.lanes(), lanes);
    assert.equal(core.call.goldenRunCount(), goldens.size);
    for (const scene of goldens.keys()) {
      assert.notEqual(core.call.goldenRun(core.text(scene)), 0, scene);
    }
  });

  for (const [scene, wanted] of goldens) {
    test(`${name}: ${scene}`, () => {
      const core = new Core(module);
      const { call } = core;
      const run = call.goldenRun(core.text(scene));
      const world = core.worldOf(scene);
      const last = Math.max(
        ...[...wanted.keys()].filter((key) => key.startsWith('tick ')).map((key) => key.slice(5)),
      );
      let compared = 0;
      let asleep = null;
      for (let tick = 0; tick <= last; ++tick) {
        assert.equal(call.worldTick(world), BigInt(tick));
        const golden = wanted.get(`tick ${tick}`);
        if (golden) assert.equal(core.roots(world), golden, `${scene}, tick ${tick}`);
        if (golden) compared += 1;
        if (asleep === null && tick > 0 && call.goldenAsleep(world)) asleep = tick;
        call.goldenStep(run, world);
      }
      assert.ok(compared > 1, `${compared} hashes were compared`);
      const sleep = wanted.get('asleep from tick');
      if (sleep) assert.equal(String(asleep), sleep, `${scene}, asleep from tick`);
    });
  }

  test(`${name}: worlds that were saved, and worlds taken back, go on with the same hashes`, () => {
    const scene = 'mixed';
    const core = new Core(module);
    const other = new Core(module);
    const { call } = core;
    const world = core.worldOf(scene);
    const checkpoint = call.checkpointNew();
    assert.equal(call.worldGoBack(world, checkpoint), 0, 'nothing was taken yet');
    for (let tick = 0; tick < 60; ++tick) call.worldStep(world);
    call.worldCheckpoint(world, checkpoint);
    const saved = core.bytes([]);
    call.worldSave(world, saved);
    const copy = other.call.worldOfSnapshot(other.bytes(core.contentOf(saved)), other.why);
    assert.notEqual(copy, 0, other.sentence());
    const seen = [];
    for (let round = 0; round < 3; ++round) {
      for (let tick = 0; tick < 20; ++tick) {
        call.worldStep(world);
        if (round === 0) other.call.worldStep(copy);
        if (round === 0) seen.push(core.roots(world));
        assert.equal(core.roots(world), seen[tick], `round ${round}, tick ${tick} after it`);
        if (round === 0) assert.equal(other.roots(copy), seen[tick], `copy, tick ${tick} after it`);
      }
      assert.equal(call.worldGoBack(world, checkpoint), 1);
      assert.equal(call.worldTick(world), 60n);
    }
  });

  test(`${name}: what moves can be read where it lies`, () => {
    const core = new Core(module);
    const { call } = core;
    const world = core.worldOf('pyramid:base=3');
    const heights = () => {
      const count = call.worldBodyCount(world);
      const motions = new Float32Array(call.memory.buffer, call.worldMotions(world), 8 * count);
      assert.equal(count, 7, 'a ground and six boxes');
      for (let i = 0; i < count; ++i) {
        const length = Math.hypot(motions[8 * i + 2], motions[8 * i + 3]);
        assert.ok(Math.abs(length - 1) < 1e-6, `the rotation of body ${i} has length ${length}`);
      }
      return Array.from({ length: count }, (_, i) => motions[8 * i + 1]);
    };
    const before = heights();
    call.worldStep(world);
    const after = heights();
    assert.equal(after[0], before[0], 'the ground stays');
    // Boxes start a little apart, so within a tick each falls by g h^2 over the substeps' sums.
    for (let i = 1; i < 7; ++i) {
      const fallen = before[i] - after[i];
      assert.ok(fallen >= 0 && fallen < 0.01, `box ${i} fell by ${fallen} m`);
    }
    assert.ok(after.some((height, i) => height < before[i]));
  });

  test(`${name}: what is no scene and no snapshot is answered with a sentence`, () => {
    const core = new Core(module);
    const { call } = core;
    for (const [text, sentence] of [
      ['nonsense', /nonsense/],
      ['pyramid:base=0x10', /'0x10' is not a number|"0x10" is not a number/],
      ['pyramid:base= 4', /is not a number/],
      ['pyramid:base=+4', /is not a number/],
      ['pyramid:base=4 ', /is not a number/],
      ['pyramid:base=', /is not a number/],
      ['pyramid:base=1e9', /must be a whole number/],
    ]) {
      assert.equal(call.worldOfScene(core.text(text), core.why), 0, text);
      assert.match(core.sentence(), sentence);
    }
    const saved = core.bytes([]);
    call.worldSave(core.worldOf('small'), saved);
    const snapshot = core.contentOf(saved);
    for (let at = 0; at < snapshot.length; at += 97) {
      const damaged = snapshot.slice();
      damaged[at] ^= 1 << (at % 8);
      const bytes = core.bytes(damaged);
      assert.equal(call.worldOfSnapshot(bytes, core.why), 0, `byte ${at}`);
      assert.ok(core.sentence().length > 10, core.sentence());
      call.bytesDelete(bytes);
    }
    assert.equal(call.bytesNew(2 ** 30), 0, 'more bytes than a snapshot has are not given');
  });

  test(`${name}: memory that is used up stops the instance, which says so`, () => {
    const core = new Core(module);
    const { call } = core;
    const words = () => {
      const bytes = new Uint8Array(call.memory.buffer, call.lastWords(), 256);
      return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
    };
    assert.equal(words(), '');
    // More worlds than the memory has room for.
    assert.throws(() => {
      for (;;) core.worldOf('many_pyramids:rows=10,columns=10,base=20');
    }, WebAssembly.RuntimeError);
    assert.match(words(), /memory|alloc/);
  });
}
