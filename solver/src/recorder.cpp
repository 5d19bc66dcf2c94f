#include "recorder.hpp"

namespace crossdem {
namespace {

template <class... Numbers>
std::string row_of(Numbers... numbers) {
  std::string row;
  ((row += (row.empty() ? "" : ",") + exact(numbers)), ...);
  return row;
}

}  // namespace

ResistanceFile::ResistanceFile(const std::filesystem::path& path, const Beginning& kept) : file_(path, kept) {
  if (kept.bytes > 0) return;
  file_.line(
      "time_s,depth_m,force_x_N,force_y_N,tip_force_y_N,shaft_force_y_N,floor_force_y_N,contacts,kinetic_energy_J");
}

void ResistanceFile::row(double time, double depth, const Simulation& simulation) {
  const BarForce force = simulation.bar_force();
  const Vector2 total = force.tip + force.shaft;
  file_.line(row_of(time, depth, total.x(), total.y(), force.tip.y(), force.shaft.y(), simulation.floor_force().y()) +
             "," + std::to_string(simulation.contacts()) + "," + exact(kinetic_energy(simulation.particles())));
}

LedgerFile::LedgerFile(const std::filesystem::path& path, const Beginning& kept) : file_(path, kept) {
  if (kept.bytes > 0) return;
  file_.line(
      "time_s,momentum_change_x_Ns,momentum_change_y_Ns,left_wall_x_Ns,left_wall_y_Ns,right_wall_x_Ns,right_wall_y_Ns,"
      "floor_x_Ns,floor_y_Ns,bar_x_Ns,bar_y_Ns,weight_x_Ns,weight_y_Ns,residual_x_Ns,residual_y_Ns,"
      "kinetic_J,spring_J,potential_change_J,bar_work_J,contact_work_J,dissipated_J,integration_J");
}

void LedgerFile::row(double time, const Simulation& simulation) {
  const MomentumLedger m = simulation.momentum_ledger();
  const EnergyLedger e = simulation.energy_ledger();
  std::string row = exact(time);
  for (const Vector2& entry : {m.change, m.left_wall, m.right_wall, m.floor, m.bar, m.weight, m.residual()})
    row += "," + row_of(entry.x(), entry.y());
  file_.line(
      row + "," +
      row_of(e.kinetic, e.spring, e.potential_change, e.bar_work, e.contact_work, e.dissipated(), e.integration()));
}

}  // namespace crossdem
