#!/usr/bin/env bash
# Fails when a user-visible file changed but CHANGELOG.md did not.
#
# usage: check_changelog.sh [BASE]
#
# BASE is a commit. The default is the point where this branch left the main branch or, on the main branch,
# the last release tag. Uncommitted changes count too.
set -euo pipefail
cd "$(git rev-parse --show-toplevel)"

fork_point() {
  local base
  for main in origin/main main; do
    base=$(git merge-base HEAD "$main" 2>/dev/null) || continue
    if [ "$base" != "$(git rev-parse HEAD)" ]; then
      echo "$base"
      return
    fi
  done
  git describe --tags --match 'v*' --abbrev=0 2>/dev/null || git rev-list --max-parents=0 HEAD | tail -n 1
}

base=${1:-$(fork_point)}
changed=$(git diff --name-only "$base" --)
visible=$(grep -E '^(include|src|cli|experiments|formats|recording)/' <<<"$changed" | head -n 1 || true)
if [ -n "$visible" ] && ! grep -qx 'CHANGELOG.md' <<<"$changed"; then
  echo "CHANGELOG.md: no entry since $(git rev-parse --short "$base") although $visible changed; add one under [Unreleased]" >&2
  exit 1
fi
