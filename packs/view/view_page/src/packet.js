// Packets of the server: a JSON head and typed arrays. See simkit_view/view/packet.py.
const TYPES = { '<f4': Float32Array, '<i4': Int32Array, '<u2': Uint16Array, '|u1': Uint8Array };

/** Returns the head of a packet, with its arrays in `head.arrays`; the arrays share the memory of the buffer. */
export function readPacket(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const arrays = {};
  for (const [name, [type, offset, shape]] of Object.entries(head.arrays)) {
    const count = shape.reduce((product, size) => product * size, 1);
    arrays[name] = new TYPES[type](buffer, 4 + length + offset, count);
  }
  head.arrays = arrays;
  return head;
}
