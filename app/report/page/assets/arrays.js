// Packed arrays of the page, decoded. All scripts of the page are plain ones that share one scope: the page opens from disk.
'use strict';

/** Bytes behind base64 text of a zlib stream. */
async function inflate(text) {
  const raw = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([raw]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Components of a packed array as Float32Array; "no value" is NaN. Integers come back exact after Math.round. */
async function unpack(packed) {
  const n = packed.count;
  const bytes = await inflate(packed.data);
  return packed.low.map((low, c) => {
    const out = new Float32Array(n);
    const step = (packed.high[c] - low) / packed.steps;
    const base = c * n * 2;
    let level = 0;
    for (let i = 0; i < n; i++) {
      const code = bytes[base + i] | (bytes[base + n + i] << 8);
      level = (level + ((code >>> 1) ^ -(code & 1))) & 0xffff;
      out[i] = level === 65535 ? NaN : low + level * step;
    }
    return out;
  });
}
