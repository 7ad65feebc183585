// Times Pinocchio. CHAIN is a text file that chain.py writes: gravity, then a line a joint.
// KERNEL is BASE.ELEMENTS.ALGORITHM. How the six coordinates of a free base are joints:
//     revolute     three sliding and three turning joints
//     zyx          a translation and a spherical joint with the angles ψ, θ, φ
//     composite    the six elementary joints composed to one
//     free_flyer   one joint with a quaternion and body velocities, states and results converted outside of what is timed
// The three of a rigid finite element: revolute, zyx, composite, likewise.
//     aba_local, aba_world                 articulated-body algorithm: q̈
//     dense_local, dense_world             crba, nonLinearEffects, Pinocchio's Cholesky: q̈
//     llt_local, llt_world                 the same with Eigen's: q̈
//     terms_local, terms_world             crba and nonLinearEffects: A, e
//     derivatives_of_aba                   computeABADerivatives: derivatives of q̈ with respect to q, q̇ and forces
// Those of a free flyer are in its tangent space: of its values A⁻¹ is converted, rows and columns of the base of the others are NaN.
#include <cmath>
#include <memory>
#include <sstream>

#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/cholesky.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/multibody.hpp>

#include "timing.hpp"

namespace pin = pinocchio;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// An elementary joint, and what sits on it: see chain.py.
struct Step {
    bool is_rotation;
    char axis;
    pin::SE3 placement;
    pin::Inertia inertia;
};

static std::vector<Step> read_chain(const std::string &path, Vector3d &gravity) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path + ": cannot be read");
    file >> gravity[0] >> gravity[1] >> gravity[2];
    std::vector<Step> steps;
    bool is_rotation;
    char axis;
    while (file >> is_rotation >> axis) {
        double numbers[25];
        for (double &number : numbers) file >> number;
        using Rows3 = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
        const Eigen::Map<const Vector3d> translation(numbers + 9), com(numbers + 13);
        steps.push_back({is_rotation, axis, pin::SE3(Rows3(numbers), translation),
                         pin::Inertia(numbers[12], com, Rows3(numbers + 16))});
    }
    return steps;
}

static pin::JointModel elementary(const Step &step) {
    if (step.is_rotation) {
        if (step.axis == 'x') return pin::JointModelRX();
        if (step.axis == 'y') return pin::JointModelRY();
        return pin::JointModelRZ();
    }
    if (step.axis == 'x') return pin::JointModelPX();
    if (step.axis == 'y') return pin::JointModelPY();
    return pin::JointModelPZ();
}

// Whether steps with these axes follow from `at` on without a placement or a mass in between.
static bool follow(const std::vector<Step> &steps, std::size_t at, const std::string &axes, bool are_rotations) {
    if (at + axes.size() > steps.size()) return false;
    for (std::size_t k = 0; k < axes.size(); ++k) {
        const Step &step = steps[at + k];
        if (step.is_rotation != are_rotations || step.axis != axes[k]) return false;
        if (k > 0 && (!step.placement.isIdentity() || steps[at + k - 1].inertia.mass() != 0)) return false;
    }
    return true;
}

static bool has_free_base(const std::vector<Step> &steps) {
    return follow(steps, 0, "xyz", false) && follow(steps, 3, "zyx", true) && steps[3].placement.isIdentity();
}

static pin::Model build(const std::vector<Step> &steps, const Vector3d &gravity, const std::string &base, const std::string &elements) {
    pin::Model model;
    model.gravity.linear() = gravity;
    pin::JointIndex last = 0;
    auto add = [&](const pin::JointModel &joint, std::size_t first, std::size_t count) {
        last = model.addJoint(last, joint, steps[first].placement, "joint" + std::to_string(first));
        model.appendBodyToJoint(last, steps[first + count - 1].inertia);
    };
    auto composed = [&](std::size_t first, std::size_t count) {
        pin::JointModelComposite joint;
        for (std::size_t k = 0; k < count; ++k) joint.addJoint(elementary(steps[first + k]));
        return joint;
    };
    std::size_t at = 0;
    if (has_free_base(steps) && base != "revolute") {
        if (base == "free_flyer") add(pin::JointModelFreeFlyer(), 0, 6);
        if (base == "composite") add(composed(0, 6), 0, 6);
        if (base == "zyx") {
            add(pin::JointModelTranslation(), 0, 3);
            add(pin::JointModelSphericalZYX(), 3, 3);
        }
        at = 6;
    } else if (has_free_base(steps)) {
        for (; at < 6; ++at) add(elementary(steps[at]), at, 1);
    }
    while (at < steps.size()) {
        if (elements == "revolute" || !follow(steps, at, "zyx", true)) {
            add(elementary(steps[at]), at, 1);
            ++at;
            continue;
        }
        if (elements == "zyx") add(pin::JointModelSphericalZYX(), at, 3);
        if (elements == "composite") add(composed(at, 3), at, 3);
        at += 3;
    }
    return model;
}

// A state in the coordinates of the model, with v = J q̇ and v̇ = J q̈ + c.
struct Converted {
    VectorXd q, v, f, c;
    MatrixXd J;
};

static Converted convert(const State &state, bool free_flyer) {
    const Eigen::Index n = state.q.size();
    const Eigen::Map<const VectorXd> q(state.q.data(), n), v(state.v.data(), n), f(state.f.data(), n);
    if (!free_flyer) return {q, v, f, VectorXd::Zero(n), MatrixXd::Identity(n, n)};
    using std::cos, std::sin;
    const double y = q[4], x = q[5], dy = v[4], dx = v[5];
    const Matrix3d R = (Eigen::AngleAxisd(q[3], Vector3d::UnitZ()) * Eigen::AngleAxisd(y, Vector3d::UnitY()) *
                        Eigen::AngleAxisd(x, Vector3d::UnitX())).toRotationMatrix();
    // Angular velocity in the body: ω = E [ψ̇ θ̇ φ̇].
    Matrix3d E, dE;
    E << -sin(y), 0, 1, cos(y) * sin(x), cos(x), 0, cos(y) * cos(x), -sin(x), 0;
    dE << -cos(y) * dy, 0, 0, -sin(y) * sin(x) * dy + cos(y) * cos(x) * dx, -sin(x) * dx, 0,
        -sin(y) * cos(x) * dy - cos(y) * sin(x) * dx, -cos(x) * dx, 0;
    Converted out{VectorXd(n + 1), VectorXd(), VectorXd(), VectorXd::Zero(n), MatrixXd::Identity(n, n)};
    out.q << q.head(3), Eigen::Quaterniond(R).coeffs(), q.tail(n - 6);
    out.J.topLeftCorner(3, 3) = R.transpose();
    out.J.block(3, 3, 3, 3) = E;
    out.v = out.J * v;
    const Vector3d linear = out.v.head(3), angular = out.v.segment(3, 3);
    out.c.head(3) = -angular.cross(linear);
    out.c.segment(3, 3) = dE * v.segment(3, 3);
    out.f = out.J.transpose().partialPivLu().solve(f);
    return out;
}

static Kernel open(const std::string &chain, const std::string &states_path, const std::string &name) {
    std::istringstream words(name);
    std::string base, elements, algorithm;
    std::getline(std::getline(std::getline(words, base, '.'), elements, '.'), algorithm);
    Vector3d gravity;
    const auto steps = read_chain(chain, gravity);
    struct Room {
        pin::Model model;
        pin::Data data;
        std::vector<Converted> states;
        Eigen::LLT<MatrixXd, Eigen::Upper> llt;
        VectorXd right;
    };
    pin::Model model = build(steps, gravity, base, elements);
    auto room = std::make_shared<Room>(Room{model, pin::Data(model), {}, Eigen::LLT<MatrixXd, Eigen::Upper>(model.nv), VectorXd(model.nv)});
    for (const State &state : read_states(states_path, steps.size()))
        room->states.push_back(convert(state, base == "free_flyer" && has_free_base(steps)));

    const auto stop = algorithm.find('_');
    const std::string method = algorithm.substr(0, stop);
    const auto convention = algorithm.substr(stop + 1) == "world" ? pin::Convention::WORLD : pin::Convention::LOCAL;
    auto terms = [=](const Converted &s) {
        pin::crba(room->model, room->data, s.q, convention);
        pin::nonLinearEffects(room->model, room->data, s.q, s.v);
        keep(room->data.M.data());
        keep(room->data.nle.data());
    };
    auto acceleration = [=](std::size_t i) {
        const Converted &s = room->states[i];
        if (method == "aba") {
            keep(pin::aba(room->model, room->data, s.q, s.v, s.f, convention).data());
            return;
        }
        terms(s);
        room->right = s.f - room->data.nle;
        if (method == "dense") {
            pin::cholesky::decompose(room->model, room->data);
            pin::cholesky::solve(room->model, room->data, room->right);
        } else {
            room->llt.compute(room->data.M);
            room->llt.solveInPlace(room->right);
        }
        keep(room->right.data());
    };
    auto numbers = [](const auto &matrix) { return std::vector<double>(matrix.data(), matrix.data() + matrix.size()); };
    if (method == "terms") {
        return {room->states.size(), [=](std::size_t i) { terms(room->states[i]); }, [=](std::size_t i) {
                    const Converted &s = room->states[i];
                    terms(s);
                    const MatrixXd full = room->data.M.template selfadjointView<Eigen::Upper>();
                    auto both = numbers(MatrixXd(s.J.transpose() * full * s.J));
                    const auto bias = numbers(VectorXd(-s.J.transpose() * (room->data.nle + full * s.c)));
                    both.insert(both.end(), bias.begin(), bias.end());
                    return both;
                }};
    }
    if (method == "derivatives") {
        auto derivatives = [=](std::size_t i) {
            const Converted &s = room->states[i];
            pin::computeABADerivatives(room->model, room->data, s.q, s.v, s.f);
            keep(room->data.ddq_dq.data());
            keep(room->data.ddq_dv.data());
            keep(room->data.Minv.data());
        };
        const bool is_free_flyer = base == "free_flyer" && has_free_base(steps);
        return {room->states.size(), derivatives, [=](std::size_t i) {
                    derivatives(i);
                    const Converted &s = room->states[i];
                    const MatrixXd inverse = room->data.Minv.template selfadjointView<Eigen::Upper>();
                    const auto back = s.J.partialPivLu();
                    std::vector<double> all;
                    auto append = [&](const MatrixXd &matrix) {
                        const MatrixXd rows = matrix.transpose();
                        all.insert(all.end(), rows.data(), rows.data() + rows.size());
                    };
                    for (MatrixXd slopes : {MatrixXd(room->data.ddq_dq), MatrixXd(room->data.ddq_dv)}) {
                        if (is_free_flyer) {
                            slopes.topRows(6).setConstant(std::nan(""));
                            slopes.leftCols(6).setConstant(std::nan(""));
                        }
                        append(slopes);
                    }
                    append(back.solve(back.solve(inverse).transpose()));
                    return all;
                }};
    }
    if (method != "aba" && method != "dense" && method != "llt") throw std::runtime_error("no kernel " + name);
    return {room->states.size(), acceleration, [=](std::size_t i) {
                acceleration(i);
                const Converted &s = room->states[i];
                const VectorXd result = method == "aba" ? room->data.ddq : room->right;
                return numbers(VectorXd(s.J.partialPivLu().solve(result - s.c)));
            }};
}

int main(int argc, char **argv) { return run(argc, argv, open); }
