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

constexpr int CHAINS = 12;
constexpr long ROUNDS = 2000000;

template <typename T> static void fused(T &a, const T &b, const T &c) { a = a * b + c; }

template <typename T> static double gigaflops() {
    T a[CHAINS], b = T{} + 0.5, c = T{} + 1.0;
    for (int k = 0; k < CHAINS; ++k) a[k] = T{} + k;
    double best = 0;
    for (int attempt = 0; attempt < 20; ++attempt) {
        const auto start = std::chrono::steady_clock::now();
        for (long i = 0; i < ROUNDS / 20; ++i) {
#pragma GCC unroll 16
            for (int k = 0; k < CHAINS; ++k) {
                fused(a[k], b, c);
#if defined(__x86_64__)
                // Keeps each chain in its own register: no chain is vectorised with another, none is left out.
                asm volatile("" : "+x"(a[k]));
#else
                asm volatile("" : "+w"(a[k]));
#endif
            }
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
