// States, numbers and times: what the programs of the other libraries have in common. They are called
//     PROGRAM values CHAIN STATES KERNEL           writes what the kernel computes at all states
//     PROGRAM time CHAIN STATES KERNEL SECONDS     prints nanoseconds a call
// CHAIN is a file of the library's own, STATES holds records t, q, v, f as 64-bit numbers.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

struct State {
    double t;
    std::vector<double> q, v, f;
};

inline std::vector<State> read_states(const std::string &path, std::size_t size) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error(path + ": cannot be read");
    std::vector<State> states;
    std::vector<double> record(1 + 3 * size);
    while (file.read(reinterpret_cast<char *>(record.data()), sizeof(double) * record.size())) {
        auto part = [&](std::size_t k) { return std::vector<double>(&record[1 + k * size], &record[1 + k * size] + size); };
        states.push_back({record[0], part(0), part(1), part(2)});
    }
    return states;
}

// Kept, so that the compiler may not leave out what leads to it.
inline void keep(const double *numbers) { asm volatile("" : : "r"(numbers) : "memory"); }

// A kernel on so many states: `call(i)` computes at state i, `values(i)` gives the numbers.
struct Kernel {
    std::size_t states;
    std::function<void(std::size_t)> call;
    std::function<std::vector<double>(std::size_t)> values;
};

inline double seconds_of(const Kernel &kernel, std::size_t passes) {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t pass = 0; pass < passes; ++pass)
        for (std::size_t i = 0; i < kernel.states; ++i) kernel.call(i);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Nanoseconds a call: the median of batches of about a millisecond, as crane-bench does.
inline double nanoseconds(const Kernel &kernel, double budget) {
    double pass = 1e9;
    for (int i = 0; i < 3; ++i) pass = std::min(pass, seconds_of(kernel, 1));
    std::size_t passes = 1;
    while (pass * passes < 1e-3) passes *= 2;
    std::vector<double> batches;
    for (double spent = 0; batches.empty() || spent < budget; spent += batches.back())
        batches.push_back(seconds_of(kernel, passes));
    std::sort(batches.begin(), batches.end());
    return batches[batches.size() / 2] * 1e9 / (passes * kernel.states);
}

// The whole program; `open` makes a kernel from CHAIN, STATES and KERNEL.
inline int run(int argc, char **argv, Kernel (*open)(const std::string &, const std::string &, const std::string &)) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    try {
        if (words.size() == 4 && words[0] == "values") {
            const Kernel kernel = open(words[1], words[2], words[3]);
            for (std::size_t i = 0; i < kernel.states; ++i) {
                const auto numbers = kernel.values(i);
                std::fwrite(numbers.data(), sizeof(double), numbers.size(), stdout);
            }
            return 0;
        }
        if (words.size() == 5 && words[0] == "time") {
            std::printf("%.6g\n", nanoseconds(open(words[1], words[2], words[3]), std::stod(words[4])));
            return 0;
        }
        std::fprintf(stderr, "write `values CHAIN STATES KERNEL` or `time CHAIN STATES KERNEL SECONDS`\n");
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    }
    return 2;
}
