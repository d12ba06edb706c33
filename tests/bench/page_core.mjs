/**
 * Times of the core as a page has it, beside those of the program: ms a tick on one thread, with
 * the hash that makes them times of the same work.
 *
 * usage: node tests/bench/page_core.mjs BUILD_FOLDER TICKS SCENE...
 */
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

const [folder, ticksAsked, ...scenes] = process.argv.slice(2);
const ticks = Number(ticksAsked);
if (!folder || !(ticks > 0) || scenes.length === 0) {
  console.error('usage: node tests/bench/page_core.mjs BUILD_FOLDER TICKS SCENE...');
  process.exit(2);
}

const quantile = (sorted, share) => sorted[Math.min(sorted.length - 1, sorted.length * share) | 0];

function row(scene, where, times, hash) {
  times.sort((a, b) => a - b);
  const shown = [0.5, 0.99].map((share) => quantile(times, share).toFixed(3).padStart(9));
  console.log(scene.padEnd(28), where.padEnd(18), ...shown, ` ${hash}`);
}

function inModule(scene, name) {
  const module = new WebAssembly.Module(readFileSync(join(folder, 'wasm', name)));
  const call = new WebAssembly.Instance(module).exports;
  call._initialize();
  const text = new TextEncoder().encode(scene);
  const bytes = call.bytesNew(text.length);
  new Uint8Array(call.memory.buffer, call.bytesAt(bytes), text.length).set(text);
  const why = call.bytesNew(0);
  const world = call.worldOfScene(bytes, why);
  if (!world) throw new Error(`there is no scene ${scene}`);
  const times = [];
  for (let tick = 0; tick < ticks; ++tick) {
    const begin = performance.now();
    call.worldStep(world);
    times.push(performance.now() - begin);
  }
  const hash = BigInt.asUintN(64, call.worldMotionRoot(world)).toString(16).padStart(16, '0');
  row(scene, `node, ${call.lanes()} lanes`, times, hash);
}

function inProgram(scene, simd) {
  const words = ['run', scene, '--ticks', String(ticks), '--threads', '1', '--simd', simd];
  const { stdout, stderr, status } = spawnSync(join(folder, 'huestep'), [...words, '--json'], {
    encoding: 'utf8',
    maxBuffer: 1 << 28,
  });
  if (status !== 0) throw new Error(stderr);
  const { ms_per_tick: ms, hash } = JSON.parse(stdout);
  const shown = [ms.median, ms.p99].map((time) => time.toFixed(3).padStart(9));
  console.log(scene.padEnd(28), `program, ${simd}`.padEnd(18), ...shown, ` ${hash.motion}`);
}

console.log('scene'.padEnd(28), 'where'.padEnd(18), 'median ms', '   p99 ms', ' motion root');
for (const scene of scenes) {
  for (const simd of ['scalar', 'sse2', 'auto']) inProgram(scene, simd);
  for (const name of ['huestep.wasm', 'huestep_simd.wasm']) inModule(scene, name);
}
