#pragma once
// How the state of a simulation goes into a checkpoint and comes back, to the last bit. Classes with private members
// say in archive() what of them does.

#include <cereal/archives/binary.hpp>
#include <cereal/types/array.hpp>
#include <cereal/types/vector.hpp>

#include "crossdem/simulation.hpp"

namespace crossdem {

using OutArchive = cereal::BinaryOutputArchive;
using InArchive = cereal::BinaryInputArchive;

template <class Archive>
void serialize(Archive& archive, Particles& p) {
  archive(p.radius, p.mass, p.inertia, p.position, p.velocity, p.displacement, p.angle, p.spin, p.rotation);
}

template <class Archive>
void serialize(Archive& archive, BarForce& force) {
  archive(force.tip, force.shaft);
}

template <class Archive>
void serialize(Archive& archive, MomentumLedger& l) {
  archive(l.left_wall, l.right_wall, l.floor, l.bar, l.weight, l.change);
}

template <class Archive>
void serialize(Archive& archive, EnergyLedger& l) {
  archive(l.kinetic, l.spring, l.potential_change, l.kinetic_change, l.spring_change, l.bar_work, l.contact_work);
}

}  // namespace crossdem

namespace Eigen {  // where the library looks for what belongs to a vector

template <class Archive, int size>
void serialize(Archive& archive, Matrix<double, size, 1>& vector) {
  archive(cereal::binary_data(vector.data(), sizeof(double) * size));
}

}  // namespace Eigen
