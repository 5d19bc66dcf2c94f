// Both ends of crossdem's contract for a code in C: reads case.json and packing.csv, writes motion.csv, resistance.csv and
// run.json. Free to copy into a code of your own. docs/own_engine.md says what the columns mean.
#pragma once
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CANNOT = 77 };  // exit status: not this case, for the reason in the last line printed

typedef struct { double x, y, r, vx, vy, w, m, fx, fy, torque; } Disc;  // SI, w counter-clockwise
typedef struct { double kn, ks, cn, cs, mu; } Law;                      // of particle_particle, or particle_wall
typedef struct {
  Law discs, walls;
  double width, gravity, dt, sample_s, frame_s;
  long rest, steps, sample, frame;  // in time steps; the bar starts when the rest is over
  char text[1 << 20];               // of case.json, which has no white space
} Case;
typedef struct { FILE *motion, *resistance; const char *folder; } Output;

static void give_up(int status, const char *why) { puts(why), exit(status); }

// The number at `table`.`key` of the case; its tables hold no tables before the key.
static double number(const Case *c, const char *table, const char *key) {
  char name[64];
  snprintf(name, sizeof name, "\"%s\":{", table);
  const char *at = strstr(c->text, name);
  snprintf(name, sizeof name, "\"%s\":", key);
  if (!at || !(at = strstr(at, name))) give_up(1, key);
  return strtod(at + strlen(name), NULL);
}

static Law law_of(const Case *c, const char *table) {
  return (Law){number(c, table, "normal_stiffness_N_m"), number(c, table, "shear_stiffness_N_m"),
               number(c, table, "normal_damping_N_s_m"), number(c, table, "shear_damping_N_s_m"),
               number(c, table, "friction")};
}

static Case read_case(const char *path) {
  static Case c;
  FILE *file = fopen(path, "r");
  if (!file || !fread(c.text, 1, sizeof c.text - 1, file)) perror(path), exit(1);
  fclose(file);
  c.discs = law_of(&c, "particle_particle"), c.walls = law_of(&c, "particle_wall");
  c.width = number(&c, "container", "width_m"), c.gravity = strtod(strstr(c.text, "\"gravity_m_s2\":") + 15, NULL);
  c.dt = number(&c, "time", "step_s");
  c.sample_s = number(&c, "time", "sample_interval_s"), c.frame_s = number(&c, "time", "frame_interval_s");
  c.rest = lround(number(&c, "time", "rest_s") / c.dt), c.steps = lround(number(&c, "time", "penetration_s") / c.dt);
  c.sample = lround(c.sample_s / c.dt), c.frame = lround(c.frame_s / c.dt);
  return c;
}

static int read_packing(const char *path, const Case *c, Disc *discs, int most) {
  char line[1024];
  int count = 0;
  FILE *file = fopen(path, "r");
  if (!file || !fgets(line, sizeof line, file)) perror(path), exit(1);
  const double density = number(c, "particles", "density_kg_m3") * number(c, "container", "thickness_m");
  for (Disc a = {0}; fgets(line, sizeof line, file); discs[count++] = a) {
    if (count == most) give_up(CANNOT, "it knows few discs: it tries each with each other");
    if (sscanf(line, "%*d,%lf,%lf,%lf,%lf,%lf,%lf", &a.x, &a.y, &a.r, &a.vx, &a.vy, &a.w) != 6) give_up(1, line);
    a.m = M_PI * a.r * a.r * density;
  }
  fclose(file);
  return count;
}

static FILE *open_in(const char *folder, const char *name, const char *title) {
  char path[4096];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "w");
  if (!file || fputs(title, file) < 0) perror(path), exit(1);
  return file;
}

static Output open_output(const char *folder) {
  return (Output){open_in(folder, "motion.csv", "time_s,id,x_m,y_m,velocity_x_m_s,velocity_y_m_s,angular_velocity_rad_s\n"),
                  open_in(folder, "resistance.csv", "time_s,depth_m,force_x_N,force_y_N,tip_force_y_N,shaft_force_y_N,"
                                                    "floor_force_y_N,contacts,kinetic_energy_J\n"), folder};
}

// To be called at every step from 0 on, when the rest is over.
static void write_step(Output out, const Case *c, long step, const Disc *discs, int count, double floor_y_N, int contacts) {
  double energy_J = 0;
  for (const Disc *a = discs; a < discs + count; ++a) {
    energy_J += a->m * (a->vx * a->vx + a->vy * a->vy + 0.5 * a->r * a->r * a->w * a->w) / 2;
    if (step % c->frame == 0)
      fprintf(out.motion, "%.17g,%d,%.17g,%.17g,%.17g,%.17g,%.17g\n", step / c->frame * c->frame_s, (int)(a - discs), a->x,
              a->y, a->vx, a->vy, a->w);
  }
  if (step % c->sample == 0)
    fprintf(out.resistance, "%.17g,0,0,0,0,0,%.17g,%d,%.17g\n", step / c->sample * c->sample_s, floor_y_N, contacts, energy_J);
}

// Last: a run without run.json is none.
static void finish(Output out, const Case *c, int count, const char *engine, const char *version) {
  if (fclose(out.motion) || fclose(out.resistance)) perror(out.folder), exit(1);
  FILE *file = open_in(out.folder, "run.json", "");
  fprintf(file, "{\"completed\":true,\"frames\":%ld,\"particles\":%d,\"engine\":\"%s\",\"version\":\"%s\"}\n",
          c->steps / c->frame + 1, count, engine, version);
  if (fclose(file)) perror(out.folder), exit(1);
}
