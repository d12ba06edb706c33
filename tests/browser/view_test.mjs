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
const { readFrame, ViewError, headerBytes } = await import(`data:text/javascript,${encodeURIComponent(source)}`);

const corpus = join(root, 'tests/protocol/corpus');
const frames = readdirSync(corpus).filter((name) => name.startsWith('View-'))
  .map((name) => ({ name, bytes: readFileSync(join(corpus, name)) }));

const bufferOf = (bytes) => bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);

/** What Cap'n Proto itself reads. */
function decoded(bytes) {
  const json = execFileSync('capnp', ['convert', 'binary:json', '-I', root, join(root, 'protocol/messages.capnp'), 'View'],
                            { input: segmentTable(bytes.subarray(headerBytes)) });
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
    contacts: Array.from({ length: view.contacts.count }, (_, i) => ({
      x: view.contacts.floats[view.contacts.stride * i],
      y: view.contacts.floats[view.contacts.stride * i + 1],
      colour: view.contacts.bytes[4 * view.contacts.stride * i + 8],
    })),
    shapes: shapes === null ? [] : Array.from({ length: shapes.count }, (_, i) => ({
      body: shapes.body[i], radius: shapes.radius[i], kind: kinds[shapes.kind[i]],
      vertexCount: shapes.first[i + 1] - shapes.first[i],
    })),
    vertices: shapes === null ? [] : [...shapes.vertices],
  };
}

test('it reads what Cap\'n Proto reads', () => {
  assert.ok(frames.length > 0);
  for (const { name, bytes } of frames) {
    const wanted = { poses: [], flags: [], contacts: [], shapes: [], vertices: [], ...decoded(bytes) };
    delete wanted.bodies;
    assert.deepEqual(plain(readFrame(bufferOf(bytes))), wanted, name);
  }
});

test('a frame cut short or with a wrong header is refused with a sentence', () => {
  const { bytes } = frames[0];
  for (let length = 0; length < bytes.length; ++length) {
    assert.throws(() => readFrame(bufferOf(bytes.subarray(0, length))), ViewError, `${length} bytes`);
  }
  for (const [at, value] of [[0, 0], [2, 9], [3, 12], [4, 1]]) {
    const other = Buffer.from(bytes);
    other[at] = value;
    assert.throws(() => readFrame(bufferOf(other)), ViewError, `byte ${at}`);
  }
});

/** A generator of our own, so that the seed is all that a failure needs. */
function randomFrom(seed) {
  let s = seed >>> 0;
  return (below) => {
    s = (Math.imul(s, 1664525) + 1013904223) >>> 0;
    return Math.floor((s / 2 ** 32) * below);
  };
}

test('damaged frames are read or refused, and nothing outside them is reached', () => {
  const seed = Number(process.env.HUESTEP_SEED ?? 20240607);
  console.log(`seed ${seed}`);
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
