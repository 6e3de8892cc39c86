// Robots in Pinocchio, out of its headers, with the compiler's flags and without dynamic memory per call.

#include <fstream>
#include <limits>
#include <string>

#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/multibody.hpp>

namespace pin = pinocchio;

namespace {

struct Robot {
    pin::Model model;
    pin::Data data;
};

Eigen::Vector3d vector(std::istream &file) {
    Eigen::Vector3d v;
    file >> v[0] >> v[1] >> v[2];
    return v;
}

Eigen::Matrix3d matrix(std::istream &file) {
    Eigen::Matrix3d rows;
    for (int i = 0; i < 3; ++i) rows.row(i) = vector(file);
    return rows;
}

pin::JointModel joint(const std::string &kind, const Eigen::Vector3d &axis) {
    if (kind == "JointModelFreeFlyer") return pin::JointModelFreeFlyer();
    if (kind == "JointModelRX") return pin::JointModelRX();
    if (kind == "JointModelRY") return pin::JointModelRY();
    if (kind == "JointModelRZ") return pin::JointModelRZ();
    if (kind == "JointModelRUBX") return pin::JointModelRUBX();
    if (kind == "JointModelRUBY") return pin::JointModelRUBY();
    if (kind == "JointModelRUBZ") return pin::JointModelRUBZ();
    if (kind == "JointModelPX") return pin::JointModelPX();
    if (kind == "JointModelPY") return pin::JointModelPY();
    if (kind == "JointModelPZ") return pin::JointModelPZ();
    if (kind == "JointModelRevoluteUnaligned") return pin::JointModelRevoluteUnaligned(axis);
    if (kind == "JointModelRevoluteUnboundedUnaligned") return pin::JointModelRevoluteUnboundedUnaligned(axis);
    if (kind == "JointModelPrismaticUnaligned") return pin::JointModelPrismaticUnaligned(axis);
    std::abort();
}

// A line per joint: parent, kind, axis, turn, place, mass, centre, inertia.
pin::Model read(const char *path) {
    pin::Model model;
    std::ifstream file(path);
    pin::JointIndex parent;
    std::string kind;
    while (file >> parent >> kind) {
        const Eigen::Vector3d axis = vector(file);
        const Eigen::Matrix3d turn = matrix(file);
        const pin::SE3 placement(turn, vector(file));
        const auto index = model.addJoint(parent, joint(kind, axis), placement, std::to_string(model.njoints));
        double mass;
        file >> mass;
        const Eigen::Vector3d centre = vector(file);
        model.appendBodyToJoint(index, pin::Inertia(mass, centre, matrix(file)));
    }
    return model;
}

using Constant = Eigen::Map<const Eigen::VectorXd>;

template <pin::Convention convention>
void acceleration(Robot *robot, const double *q, const double *v, const double *torque, double *result) {
    const auto size = robot->model.nv;
    Eigen::Map<Eigen::VectorXd>(result, size) = pin::aba(
        robot->model, robot->data, Constant(q, robot->model.nq), Constant(v, size), Constant(torque, size), convention);
}

}  // namespace

extern "C" Robot *robot(const char *path) {
    const pin::Model model = read(path);
    return new Robot{model, pin::Data(model)};
}

extern "C" void local(Robot *robot, const double *q, const double *v, const double *torque, double *result) {
    acceleration<pin::Convention::LOCAL>(robot, q, v, torque, result);
}

extern "C" void world(Robot *robot, const double *q, const double *v, const double *torque, double *result) {
    acceleration<pin::Convention::WORLD>(robot, q, v, torque, result);
}

// The accelerations with their derivatives by positions, rates and torques, which stay in `data`.
extern "C" void slopes(Robot *robot, const double *q, const double *v, const double *torque, double *result) {
    const auto size = robot->model.nv;
    pin::computeABADerivatives(
        robot->model, robot->data, Constant(q, robot->model.nq), Constant(v, size), Constant(torque, size));
    Eigen::Map<Eigen::VectorXd>(result, size) = robot->data.ddq;
}
