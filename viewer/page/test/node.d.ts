// The part of node's types that the tests use. The page itself must not see node's types.
declare module "node:test" {
  export function test(name: string, body: () => void | Promise<void>): void;
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
