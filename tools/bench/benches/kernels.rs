//! Times all kernels: `cargo bench -p crane-bench`, or those with a part of a name, `cargo bench -p crane-bench -- rk4_step/25`.

use crane_bench::cranes;
use criterion::{Criterion, criterion_group, criterion_main};

fn kernels(criterion: &mut Criterion) {
    for entry in cranes::all() {
        for mut kernel in (entry.kernels)() {
            let name = format!("{}/{}", kernel.name, entry.coordinates);
            criterion.bench_function(&name, |bencher| bencher.iter_custom(|calls| kernel.time(calls)));
        }
    }
}

criterion_group!(benches, kernels);
criterion_main!(benches);
