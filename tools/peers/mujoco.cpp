// Times MuJoCo. CHAIN is a compiled model (.mjb), as mujoco_peer.py writes it.
//     forward   mj_forward with the generalized forces applied: qacc
//     rk4_step  mj_step of a model that has the forces as springs and dampers: qpos, qvel
#include <memory>

#include <mujoco/mujoco.h>

#include "timing.hpp"

static Kernel open(const std::string &chain, const std::string &states_path, const std::string &name) {
    std::shared_ptr<mjModel> model(mj_loadModel(chain.c_str(), nullptr), mj_deleteModel);
    if (!model) throw std::runtime_error(chain + ": no model of MuJoCo");
    std::shared_ptr<mjData> data(mj_makeData(model.get()), mj_deleteData);
    auto states = std::make_shared<std::vector<State>>(read_states(states_path, model->nv));
    const int n = model->nv;
    auto set = [=](std::size_t i) {
        mju_copy(data->qpos, (*states)[i].q.data(), n);
        mju_copy(data->qvel, (*states)[i].v.data(), n);
    };
    auto numbers = [n](const mjtNum *from) { return std::vector<double>(from, from + n); };
    if (name == "forward") {
        auto call = [=](std::size_t i) {
            set(i);
            mju_copy(data->qfrc_applied, (*states)[i].f.data(), n);
            mj_forward(model.get(), data.get());
            keep(data->qacc);
        };
        return {states->size(), call, [=](std::size_t i) { return call(i), numbers(data->qacc); }};
    }
    if (name == "rk4_step") {
        auto call = [=](std::size_t i) {
            set(i);
            mj_step(model.get(), data.get());
            keep(data->qpos);
        };
        return {states->size(), call, [=](std::size_t i) {
                    call(i);
                    auto both = numbers(data->qpos);
                    both.insert(both.end(), data->qvel, data->qvel + n);
                    return both;
                }};
    }
    throw std::runtime_error("no kernel " + name);
}

int main(int argc, char **argv) { return run(argc, argv, open); }
