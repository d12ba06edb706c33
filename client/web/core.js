/**
 * The core as WebAssembly: the program that a server steps its sessions with, in the page.
 *
 * client/wasm/exports.h says what is called and how. The module comes in two forms that compute
 * the same bits, with and without SIMD instructions; a browser that does not know those could not
 * load the first.
 */

/** A module of one function that makes a vector: valid where SIMD instructions are known. */
const vectors = new Uint8Array([
  ...[0x00, 0x61, 0x73, 0x6d, 1, 0, 0, 0], // magic and version
  ...[1, 5, 1, 0x60, 0, 1, 0x7b], // a type: nothing to a vector
  ...[3, 2, 1, 0], // one function of it
  ...[10, 8, 1, 6, 0, 0x41, 0, 0xfd, 0x11, 0x0b], // i32.const 0, i32x4.splat, end
]);

/** What has stopped the core, or kept it from being there: a sentence. */
export class CoreError extends Error {}

/**
 * @typedef {Record<string, (...values: any[]) => any>} Calls
 */

/** One instance, and bytes in and out of it. A handle or address in it is a number. */
export class Core {
  /** @param {WebAssembly.Instance} instance */
  constructor(instance) {
    this.exports = /** @type {Calls} */ (/** @type {unknown} */ (instance.exports));
    this.memory = /** @type {WebAssembly.Memory} */ (instance.exports.memory);
    this.exports._initialize();
    this.input = this.call('bytesNew', 0);
    this.output = this.call('bytesNew', 0);
    this.why = this.call('bytesNew', 0);
    /** How many numbers it works on side by side. @type {number} */
    this.lanes = this.call('lanes');
  }

  /**
   * @returns {Promise<Core>}
   * @throws {CoreError} where the browser or the server has none
   */
  static async load() {
    if (typeof WebAssembly !== 'object') throw new CoreError('this browser has no WebAssembly');
    const simd = WebAssembly.validate(vectors);
    const reply = await fetch(simd ? '/core_simd.wasm' : '/core.wasm');
    if (!reply.ok) throw new CoreError('this server was built without a core for browsers');
    const { instance } = await WebAssembly.instantiateStreaming(reply);
    return new Core(instance);
  }

  /**
   * Calls a function of the module. An instance that stopped cannot go on.
   * @param {string} name
   * @param {...any} values
   * @returns {any}
   * @throws {CoreError}
   */
  call(name, ...values) {
    try {
      return this.exports[name](...values);
    } catch (problem) {
      if (!(problem instanceof WebAssembly.RuntimeError)) throw problem;
      throw new CoreError(this.lastWords() || String(problem));
    }
  }

  lastWords() {
    const at = this.exports.lastWords();
    const bytes = new Uint8Array(this.memory.buffer, at, 256);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }

  /** Puts bytes where a call may read them. @param {Uint8Array} content @returns {number} */
  put(content) {
    if (!this.call('bytesResize', this.input, content.length))
      throw new CoreError(`${content.length} bytes at once are more than the core takes`);
    const at = this.call('bytesAt', this.input);
    new Uint8Array(this.memory.buffer, at, content.length).set(content);
    return this.input;
  }

  /** @param {string} text */
  putText(text) {
    return this.put(new TextEncoder().encode(text));
  }

  /** A copy of bytes that a call has left. @param {number} bytes */
  take(bytes = this.output) {
    const size = this.call('bytesSize', bytes);
    return new Uint8Array(this.memory.buffer, this.call('bytesAt', bytes), size).slice();
  }

  /** The sentence of the last refusal. */
  sentence() {
    return new TextDecoder().decode(this.take(this.why));
  }

  /** Numbers of 64 bits from an address on. @param {number} address @param {number} count */
  numbers(address, count) {
    return new BigUint64Array(this.memory.buffer, address, count).slice();
  }
}
