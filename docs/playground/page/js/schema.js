// The keys that are possible at a position of a model file, by the generator's own schema.

/** The keys with their schemas, and the words that may be values, of the value under this path of keys. */
export function below(schema, path) {
  let nodes = [schema];
  for (const key of path) nodes = nodes.flatMap((node) => variants(node)).flatMap((node) => step(node, key));
  return nodes.flatMap((node) => variants(node));
}

/** A node, and the alternatives that it has. */
function variants(node) {
  return node && typeof node === "object" ? [node, ...(node.anyOf ?? []).flatMap(variants)] : [];
}

function step(node, key) {
  if (key === null) return node.items ? [node.items] : [];
  const own = node.properties?.[key];
  if (own) return [own];
  return node.additionalProperties && typeof node.additionalProperties === "object" ? [node.additionalProperties] : [];
}

/** The keys that may stand in the map under this path. */
export function keys(schema, path) {
  const found = new Map();
  for (const node of below(schema, path)) {
    for (const [key, value] of Object.entries(node.properties ?? {})) {
      if (value && typeof value === "object") found.set(key, value);
    }
  }
  return found;
}

/** The words that may be the value under this path. */
export function choices(schema, path) {
  return [...new Set(below(schema, path).flatMap((node) => node.enum ?? []))];
}

/** The description of a key, in a line. */
export function about(schema, path) {
  return below(schema, path).map((node) => node.description).find(Boolean);
}
