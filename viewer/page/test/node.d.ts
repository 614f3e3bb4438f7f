// The part of node's types that the tests use. The page itself must not see node's types.
declare module "node:test" {
  export function test(name: string, body: () => void | Promise<void>): void;
  export function test(name: string, options: { skip: boolean }, body: () => void | Promise<void>): void;
}
declare module "node:fs" {
  export function readFileSync(path: string): Uint8Array;
  export function readFileSync(path: string, encoding: "utf8"): string;
}
declare module "node:assert/strict" {
  interface Assert {
    (value: unknown, message?: string): asserts value;
    equal(actual: unknown, expected: unknown, message?: string): void;
    deepEqual(actual: unknown, expected: unknown, message?: string): void;
    throws(body: () => unknown, expected?: unknown, message?: string): void;
  }
  interface Assert {
    ok(value: unknown, message?: string): asserts value;
  }
  const assert: Assert;
  export default assert;
}
