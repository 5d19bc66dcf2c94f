// The overlaps of the discs of a bed, of which the viewer draws force chains.
"use strict";
// visit(i, j, overlap) of each pair that overlaps; x, y and radius of all discs in one unit of length.
function visitOverlaps(x, y, radius, visit) {
  const width = 2 * radius.reduce((largest, one) => Math.max(largest, one), 0); // of square cells: partners are in the eight around
  const cells = new Map();
  const key = (column, row) => column * 0x10000 + row;
  for (let i = 0; i < radius.length; i++) {
    const column = Math.floor(x[i] / width);
    const row = Math.floor(y[i] / width);
    for (let c = column - 1; c <= column + 1; c++)
      for (let r = row - 1; r <= row + 1; r++)
        for (const j of cells.get(key(c, r)) ?? []) {
          const overlap = radius[i] + radius[j] - Math.sqrt((x[i] - x[j]) ** 2 + (y[i] - y[j]) ** 2);
          if (overlap > 0) visit(j, i, overlap);
        }
    const own = cells.get(key(column, row));
    if (own) own.push(i);
    else cells.set(key(column, row), [i]);
  }
}
