/** The page's reader of Views against Cap'n Proto's own decoder, and against damaged frames. */
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

const root = process.env.HUESTEP_SOURCE ?? fileURLToPath(new URL('../..', import.meta.url));
// As a data address, so that the page's files need no package.json to count as modules.
const source = readFileSync(join(root, 'client/web/view.js'), 'utf8');
const { readFrame, ViewError, headerBytes } = await import(
  `data:text/javascript,${encodeURIComponent(source)}`
);

const corpus = join(root, 'tests/protocol/corpus');
const frames = readdirSync(corpus)
  .filter((name) => name.startsWith('View-'))
  .map((name) => ({ name, bytes: readFileSync(join(corpus, name)) }));

const bufferOf = (bytes) => bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);

/** A generator of our own, so that the seed is all that a failure needs. */
function randomFrom(seed) {
  let s = seed >>> 0;
  return (below) => {
    s = (Math.imul(s, 1664525) + 1013904223) >>> 0;
    return Math.floor((s / 2 ** 32) * below);
  };
}

const seed = Number(process.env.HUESTEP_SEED ?? 20240607);
console.log(`seed ${seed}`);

/** What Cap'n Proto itself reads. */
function decoded(bytes) {
  const json = execFileSync(
    'capnp',
    ['convert', 'binary:json', '-I', root, join(root, 'protocol/messages.capnp'), 'View'],
    { input: segmentTable(bytes.subarray(headerBytes)) },
  );
  return JSON.parse(json);
}

/** The command reads messages with a table of segments in front. */
function segmentTable(payload) {
  const table = Buffer.alloc(8);
  table.writeUInt32LE(payload.length / 8, 4);
  return Buffer.concat([table, payload]);
}

/** A view as Cap'n Proto's JSON has it. */
function plain(view) {
  const shapes = view.shapes;
  const kinds = ['circle', 'capsule', 'polygon', 'segment'];
  return {
    tick: String(view.tick),
    root: String(BigInt(`0x${view.root}`)),
    players: view.players,
    definitions: view.definitions,
    poses: [...view.poses],
    flags: [...view.flags],
    joints: [...view.joints],
    score: view.score,
    contacts: Array.from({ length: view.contacts.count }, (_, i) => ({
      x: view.contacts.floats[view.contacts.stride * i],
      y: view.contacts.floats[view.contacts.stride * i + 1],
      colour: view.contacts.bytes[4 * view.contacts.stride * i + 8],
    })),
    shapes:
      shapes === null
        ? []
        : Array.from({ length: shapes.count }, (_, i) => ({
            body: shapes.body[i],
            radius: shapes.radius[i],
            kind: kinds[shapes.kind[i]],
            vertexCount: shapes.first[i + 1] - shapes.first[i],
          })),
    vertices: shapes === null ? [] : [...shapes.vertices],
  };
}

test("it reads what Cap'n Proto reads", () => {
  assert.ok(frames.length > 0);
  for (const { name, bytes } of frames) {
    const wanted = {
      poses: [],
      flags: [],
      joints: [],
      score: '',
      contacts: [],
      shapes: [],
      vertices: [],
      ...decoded(bytes),
    };
    delete wanted.bodies;
    assert.deepEqual(plain(readFrame(bufferOf(bytes))), wanted, name);
  }
});

/** Writes a View as Cap'n Proto itself does, with the frame's header in front. */
function encoded(view) {
  const payload = execFileSync(
    'capnp',
    ['convert', 'json:flat', '-I', root, join(root, 'protocol/messages.capnp'), 'View'],
    { input: JSON.stringify(view) },
  );
  const header = Buffer.alloc(headerBytes);
  header.writeUInt16LE(0x4875, 0);
  header.writeUInt8(1, 2);
  header.writeUInt8(13, 3);
  header.writeUInt32LE(payload.length, 4);
  return Buffer.concat([header, payload]);
}

test("it reads what Cap'n Proto writes, joints and shapes and all", () => {
  const random = randomFrom(seed);
  const real = () => Math.fround(random(2000) / 8 - 100);
  const list = (count, make) => Array.from({ length: count }, make);
  for (let round = 0; round < 12; ++round) {
    const bodies = 1 + random(9);
    const kinds = ['circle', 'capsule', 'polygon', 'segment'];
    const shapes = list(random(12), () => {
      const kind = random(4);
      return {
        body: random(bodies),
        radius: real(),
        kind: kinds[kind],
        vertexCount: [1, 2, 3 + random(6), 2][kind],
      };
    });
    const view = {
      tick: String(random(2 ** 31) * 2 ** 20),
      root: String((BigInt(random(2 ** 31)) << 33n) + BigInt(random(2 ** 31))),
      players: random(64),
      definitions: 1 + random(99),
      poses: list(4 * bodies, real),
      flags: list(bodies, () => random(16)),
      contacts: list(random(9), () => ({ x: real(), y: real(), colour: random(256) })),
      bodies: list(bodies, () => random(2 ** 31)),
      shapes,
      vertices: list(2 * shapes.reduce((sum, shape) => sum + shape.vertexCount, 0), real),
      joints: list(4 * random(7), real),
      score: random(2) ? `red ${random(9)} : ${random(9)} blue` : '',
    };
    const read = plain(readFrame(bufferOf(encoded(view))));
    delete view.bodies;
    assert.deepEqual(read, view, `seed ${seed}, round ${round}`);
  }
});

test('a frame cut short or with a wrong header is refused with a sentence', () => {
  const { bytes } = frames[0];
  for (let length = 0; length < bytes.length; ++length) {
    assert.throws(
      () => readFrame(bufferOf(bytes.subarray(0, length))),
      ViewError,
      `${length} bytes`,
    );
  }
  for (const [at, value] of [
    [0, 0],
    [2, 9],
    [3, 12],
    [4, 1],
  ]) {
    const other = Buffer.from(bytes);
    other[at] = value;
    assert.throws(() => readFrame(bufferOf(other)), ViewError, `byte ${at}`);
  }
});

test('damaged frames are read or refused, and nothing outside them is reached', () => {
  const random = randomFrom(seed);
  let refused = 0;
  for (let round = 0; round < 20_000; ++round) {
    const bytes = Buffer.from(frames[random(frames.length)].bytes);
    for (let flips = 1 + random(4); flips > 0; --flips) {
      bytes[headerBytes + random(bytes.length - headerBytes)] ^= 1 << random(8);
    }
    try {
      const view = readFrame(bufferOf(bytes));
      assert.equal(view.poses.length, 4 * view.bodies);
      assert.ok(view.contacts.bytes.length <= bytes.length);
      if (view.shapes) {
        assert.ok(view.shapes.body.every((body) => body < view.bodies));
        assert.equal(2 * view.shapes.first[view.shapes.count], view.shapes.vertices.length);
      }
    } catch (problem) {
      // A RangeError would be a check that is missing, though typed arrays keep it harmless.
      assert.ok(problem instanceof ViewError, `seed ${seed}, round ${round}: ${problem.stack}`);
      refused += 1;
    }
  }
  assert.ok(refused > 1000, `${refused} were refused`);
});
