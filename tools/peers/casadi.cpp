// Times C that CasADi wrote. CHAIN is a shared library of it; KERNEL one of its functions of q, v and, if there is a third,
// of the forces.
#include <dlfcn.h>

#include <memory>

#include "timing.hpp"

using Function = int (*)(const double **, double **, long long *, double *, int);
using Count = long long (*)();
using Sparsity = const long long *(*)(long long);
using Work = int (*)(long long *, long long *, long long *, long long *);

template <typename T> static T symbol(void *library, const std::string &name) {
    void *found = dlsym(library, name.c_str());
    if (!found) throw std::runtime_error(name + ": not in the library");
    return reinterpret_cast<T>(found);
}

static Kernel open(const std::string &chain, const std::string &states_path, const std::string &name) {
    void *library = dlopen(chain.c_str(), RTLD_NOW);
    if (!library) throw std::runtime_error(dlerror());
    const auto function = symbol<Function>(library, name);
    const auto arguments = symbol<Count>(library, name + "_n_in")(), results = symbol<Count>(library, name + "_n_out")();
    const auto shape_in = symbol<Sparsity>(library, name + "_sparsity_in"), shape_out = symbol<Sparsity>(library, name + "_sparsity_out");
    auto states = std::make_shared<std::vector<State>>(read_states(states_path, shape_in(0)[0]));

    long long sizes[4];
    symbol<Work>(library, name + "_work")(&sizes[0], &sizes[1], &sizes[2], &sizes[3]);
    struct Room {
        std::vector<const double *> in;
        std::vector<double *> out;
        std::vector<long long> integers;
        std::vector<double> reals, result;
    };
    auto room = std::make_shared<Room>(Room{std::vector<const double *>(sizes[0]), std::vector<double *>(sizes[1]),
                                            std::vector<long long>(sizes[2] + 1), std::vector<double>(sizes[3] + 1), {}});
    std::size_t length = 0;
    for (long long k = 0; k < results; ++k) length += shape_out(k)[0] * shape_out(k)[1];
    room->result.resize(length);
    length = 0;
    for (long long k = 0; k < results; length += shape_out(k)[0] * shape_out(k)[1], ++k) room->out[k] = &room->result[length];

    auto call = [=](std::size_t i) {
        const State &state = (*states)[i];
        const double *all[] = {state.q.data(), state.v.data(), state.f.data()};
        std::copy(all, all + arguments, room->in.begin());
        function(room->in.data(), room->out.data(), room->integers.data(), room->reals.data(), 0);
        keep(room->result.data());
    };
    return {states->size(), call, [=](std::size_t i) { return call(i), room->result; }};
}

int main(int argc, char **argv) { return run(argc, argv, open); }
