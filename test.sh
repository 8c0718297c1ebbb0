#!/usr/bin/env bash
# Sets up and passes the tests: formatting, lints, docs, doc tests, then all other tests.
set -euo pipefail
cd "$(dirname "$0")"
for part in rustfmt clippy; do
    if ! cargo "${part/rustfmt/fmt}" --version >/dev/null 2>&1; then
        rustup component add "$part"
    fi
done
cargo fmt --all --check
cargo clippy --workspace --all-targets --locked -- -D warnings
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked
cargo check -p supersurface --no-default-features --locked
cargo test --workspace --doc --locked
cargo test --workspace --lib --bins --tests --locked
