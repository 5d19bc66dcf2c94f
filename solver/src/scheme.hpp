#pragma once
// A scheme is what moves the particles: a law, an integrator and the order of both. One function turns the scheme that
// a case names into its type.

#include <memory>

#include "world.hpp"

namespace crossdem {

/// Sets up `world`, whose particles and bar are there, for the scheme of the case.
std::unique_ptr<Stepper> make_stepper(const Case& setup, World& world);

}  // namespace crossdem
