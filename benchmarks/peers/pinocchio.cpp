// The chains and the arm in Pinocchio, out of its headers, with the compiler's flags and without dynamic memory per call.

#include <array>
#include <memory>

#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/multibody.hpp>

#include "links.h"

namespace pin = pinocchio;

namespace {

struct Engine {
    pin::Model model;
    std::unique_ptr<pin::Data> data;
    double damping;
    Eigen::VectorXd q, v, torque;

    Engine(const Link *links, int count, double damping) : damping(damping), q(count), v(count), torque(count) {
        pin::JointIndex parent = 0;
        for (int number = 0; number < count; ++number) {
            const Link &link = links[number];
            const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> turn(link.turn), inertia(link.inertia);
            const pin::SE3 placement(turn, Eigen::Map<const Eigen::Vector3d>(link.place));
            const std::string name = "joint" + std::to_string(number);
            if (link.axis == 0) parent = model.addJoint(parent, pin::JointModelRX(), placement, name);
            if (link.axis == 1) parent = model.addJoint(parent, pin::JointModelRY(), placement, name);
            if (link.axis == 2) parent = model.addJoint(parent, pin::JointModelRZ(), placement, name);
            const pin::Inertia body(link.mass, Eigen::Map<const Eigen::Vector3d>(link.centre), inertia);
            model.appendBodyToJoint(parent, body);
        }
        data = std::make_unique<pin::Data>(model);
    }

    void read(const double *x, const double *u) {
        const auto count = q.size();
        q = Eigen::Map<const Eigen::VectorXd>(x, count);
        v = Eigen::Map<const Eigen::VectorXd>(x + count, count);
        torque = Eigen::Map<const Eigen::VectorXd>(u, count) - damping * v;
    }

    template <pin::Convention convention>
    void value(const double *x, const double *u, double *result) {
        const auto count = q.size();
        read(x, u);
        Eigen::Map<Eigen::VectorXd>(result, count) = v;
        Eigen::Map<Eigen::VectorXd>(result + count, count) = pin::aba(model, *data, q, v, torque, convention);
    }

    void jacobian(const double *x, const double *u, double *result) {
        const auto count = q.size();
        read(x, u);
        pin::computeABADerivatives(model, *data, q, v, torque);
        Eigen::Map<Eigen::VectorXd>(result, count) = v;
        Eigen::Map<Eigen::VectorXd>(result + count, count) = data->ddq;
        Eigen::Map<Eigen::MatrixXd> slope(result + 2 * count, 2 * count, 2 * count);
        slope.topRows(count).setZero();
        slope.topRightCorner(count, count).diagonal().setOnes();
        slope.bottomLeftCorner(count, count) = data->ddq_dq;
        slope.bottomRightCorner(count, count) = data->ddq_dv;
        // Only the upper triangle of the inverse mass matrix is given.
        data->Minv.triangularView<Eigen::StrictlyLower>() = data->Minv.transpose().triangularView<Eigen::StrictlyLower>();
        slope.bottomRightCorner(count, count) -= damping * data->Minv;
    }
};

template <const auto &links>
Engine &engine(double damping) {
    static Engine engine(links, sizeof links / sizeof links[0], damping);
    return engine;
}

}  // namespace

#define CHAIN(name)                                                                              \
    extern "C" void pinocchio_##name##_value_local(const double *x, const double *u, double *r) { \
        engine<name>(name##_damping).value<pin::Convention::LOCAL>(x, u, r);                      \
    }                                                                                            \
    extern "C" void pinocchio_##name##_value_world(const double *x, const double *u, double *r) { \
        engine<name>(name##_damping).value<pin::Convention::WORLD>(x, u, r);                      \
    }                                                                                            \
    extern "C" void pinocchio_##name##_jacobian_derivatives(const double *x, const double *u, double *r) { \
        engine<name>(name##_damping).jacobian(x, u, r);                                           \
    }

CHAIN(chain8)
CHAIN(chain16)
CHAIN(chain64)
CHAIN(arm)
