// The most floating-point operations a second that one core does here: multiplications fused with additions, on scalars and
// on the widest vectors, in as many independent chains as hide their latency.
#include <chrono>
#include <cstdio>

#if defined(__AVX512F__)
using Vector = double __attribute__((vector_size(64)));
#elif defined(__AVX__)
using Vector = double __attribute__((vector_size(32)));
#else
using Vector = double __attribute__((vector_size(16)));
#endif

// As many as are named below.
constexpr int CHAINS = 12;
constexpr long ROUNDS = 2000000;

// One fused multiply-add. The empty statement keeps each chain in a register of its own: no chain is vectorised with another, none is
// left out. The chains are separate variables, since gcc keeps an array whose elements it names in memory.
template <typename T> static inline void fused(T &a, const T &b, const T &c) {
    a = a * b + c;
#if defined(__x86_64__)
    asm volatile("" : "+x"(a));
#else
    asm volatile("" : "+w"(a));
#endif
}

template <typename T> static double gigaflops() {
    const T b = T{} + 0.5, c = T{} + 1.0;
    T a0{}, a1{}, a2{}, a3{}, a4{}, a5{}, a6{}, a7{}, a8{}, a9{}, a10{}, a11{};
    double best = 0;
    for (int attempt = 0; attempt < 20; ++attempt) {
        const auto start = std::chrono::steady_clock::now();
        for (long i = 0; i < ROUNDS / 20; ++i) {
            fused(a0, b, c), fused(a1, b, c), fused(a2, b, c), fused(a3, b, c), fused(a4, b, c), fused(a5, b, c);
            fused(a6, b, c), fused(a7, b, c), fused(a8, b, c), fused(a9, b, c), fused(a10, b, c), fused(a11, b, c);
        }
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        const double operations = 2.0 * CHAINS * (ROUNDS / 20) * (sizeof(T) / sizeof(double));
        if (operations / time.count() > best) best = operations / time.count();
    }
    return best / 1e9;
}

int main() {
    std::printf("%.4g %.4g\n", gigaflops<double>(), gigaflops<Vector>());
}
