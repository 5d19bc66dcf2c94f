// A discrete element code as small as it can be: a few discs, a floor and two walls; springs, dashpots and friction.
//   cc -O2 -o discs discs.c -lm
#include "contract.h"

enum { MOST = 64, LEFT = MOST, RIGHT, FLOOR };  // surfaces: every disc, and these three
static Disc disc[MOST];
static double spring[MOST][FLOOR + 1];  // shear force of each contact [N]
static int count, contacts;
static double floor_y_N;

// Disc a on b, which it overlaps in the direction (nx, ny); what stands still is a disc of radius 0. Returns the push [N].
static double touch(Disc *a, Disc *b, double *shear, double nx, double ny, double overlap, Law law, double dt) {
  if (overlap < 0) return *shear = 0;
  const double ux = a->vx - b->vx, uy = a->vy - b->vy;
  const double slip = -ux * ny + uy * nx + a->w * a->r + b->w * b->r;
  const double push = law.kn * overlap + law.cn * (ux * nx + uy * ny);
  const double cap = law.mu * law.kn * overlap;
  *shear += law.ks * slip * dt;
  const int slips = fabs(*shear) > cap;
  if (slips) *shear = copysign(cap, *shear);
  const double drag = slips ? *shear : *shear + law.cs * slip;
  const double fx = push * nx - drag * ny, fy = push * ny + drag * nx;
  a->fx -= fx, a->fy -= fy, a->torque -= a->r * drag;
  b->fx += fx, b->fy += fy, b->torque -= b->r * drag;
  return push;
}

static void add_up_forces(const Case *c) {
  contacts = 0, floor_y_N = 0;
  for (Disc *a = disc; a < disc + count; ++a) a->fx = a->torque = 0, a->fy = -a->m * c->gravity;
  for (int i = 0; i < count; ++i) {
    Disc *a = &disc[i], still = {0};
    touch(a, &still, &spring[i][LEFT], -1, 0, a->r - a->x, c->walls, c->dt);
    touch(a, &still, &spring[i][RIGHT], 1, 0, a->r + a->x - c->width, c->walls, c->dt);
    floor_y_N -= touch(a, &still, &spring[i][FLOOR], 0, -1, a->r - a->y, c->walls, c->dt);
    for (int j = i + 1; j < count; ++j) {
      Disc *b = &disc[j];
      const double dx = b->x - a->x, dy = b->y - a->y, apart = hypot(dx, dy), overlap = a->r + b->r - apart;
      contacts += overlap > 0;
      touch(a, b, &spring[i][j], dx / apart, dy / apart, overlap, c->discs, c->dt);
    }
  }
}

static void half_kick(double dt) {
  for (Disc *a = disc; a < disc + count; ++a) {
    a->vx += a->fx / a->m * dt / 2, a->vy += a->fy / a->m * dt / 2;
    a->w += a->torque / (0.4 * a->m * a->r * a->r) * dt / 2;
  }
}

int main(int argc, char **argv) {
  if (argc != 7) return puts("discs 1.0"), argc != 2;  // --version
  const Case c = read_case(argv[2]);
  if (strstr(c.text, "\"bar\":{") || strstr(c.text, "rolling_friction") || strstr(c.text, "tensile_strength_N"))
    give_up(CANNOT, "it knows no bar, no joints and no resistance to rolling");
  count = read_packing(argv[4], &c, disc, MOST);
  const Output out = open_output(argv[6]);
  add_up_forces(&c);
  for (long step = -c.rest;; ++step) {  // velocity Verlet
    if (step >= 0) write_step(out, &c, step, disc, count, floor_y_N, contacts);
    if (step == c.steps) break;
    half_kick(c.dt);
    for (Disc *a = disc; a < disc + count; ++a) a->x += a->vx * c.dt, a->y += a->vy * c.dt;
    add_up_forces(&c);
    half_kick(c.dt);
  }
  finish(out, &c, count, "discs", "discs 1.0");
}
