#include <hdf5.h>

#include <array>

#include "crossdem/version.hpp"
#include "recorder.hpp"

namespace crossdem {
namespace {

/// An HDF5 identifier that closes itself. A negative identifier is an error of the library, reported as WriteError.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close, const std::filesystem::path& path) : id_(id), close_(close) {
    if (id_ < 0) throw WriteError(path, "HDF5 could not write it; is the disk full?");
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor): stands for the id in the C interface

 private:
  hid_t id_;
  Close close_;
};

hid_t create(const std::filesystem::path& path) {
  H5dont_atexit();                              // its exit handler crashes on a file that a full disk kept from closing
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are thrown here, not printed there
  return H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
}

using Shape = std::vector<hsize_t>;

}  // namespace

struct MotionFile::File {
  File(std::filesystem::path at, const Case& setup, const Particles& particles);
  void frame(long step, double time, std::optional<double> bar_tip, const Particles& particles);

 private:
  void require(herr_t status) const {
    if (status < 0) throw WriteError(path, "HDF5 could not write it; is the disk full?");
  }

  void group(const char* name) const {
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, path);
    require(H5Pset_create_intermediate_group(links, 1));
    const Handle made(H5Gcreate2(file, name, links, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path);
  }

  void attribute(const char* object, const char* name, hid_t type, const void* values, hsize_t count) const {
    const Handle space(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose, path);
    const Handle made(H5Acreate_by_name(file, object, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                      H5Aclose, path);
    require(H5Awrite(made, type, values));
  }

  void text_attribute(const char* object, const char* name, const std::string& text) const {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, path);
    require(H5Tset_size(type, text.size()));
    require(H5Tset_cset(type, H5T_CSET_UTF8));
    attribute(object, name, type, text.data(), 1);
  }

  void whole(const char* name, hid_t type, const Shape& shape, const void* values) const {
    const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose, path);
    const Handle set(H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose, path);
    require(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
  }

  /// A data set that grows by one entry of shape `entry` a frame.
  void growing(const char* name, hid_t type, const Shape& entry) const {
    Shape now{0};
    Shape most{H5S_UNLIMITED};
    Shape chunk{entry.empty() ? hsize_t{1024} : hsize_t{1}};
    for (Shape* shape : {&now, &most, &chunk}) shape->insert(shape->end(), entry.begin(), entry.end());
    const Handle space(H5Screate_simple(static_cast<int>(now.size()), now.data(), most.data()), H5Sclose, path);
    const Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, path);
    require(H5Pset_chunk(layout, static_cast<int>(chunk.size()), chunk.data()));
    const Handle set(H5Dcreate2(file, name, type, space, H5P_DEFAULT, layout, H5P_DEFAULT), H5Dclose, path);
  }

  void append(const char* name, hid_t type, const Shape& entry, const void* values) const {
    const Handle set(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose, path);
    Shape start{frames};
    Shape count{1};
    Shape now{frames + 1};
    for (const hsize_t size : entry) {
      start.push_back(0);
      count.push_back(size);
      now.push_back(size);
    }
    require(H5Dset_extent(set, now.data()));
    const Handle in_file(H5Dget_space(set), H5Sclose, path);
    require(H5Sselect_hyperslab(in_file, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr));
    const Handle in_memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose, path);
    require(H5Dwrite(set, type, in_memory, in_file, H5P_DEFAULT, values));
  }

  /// An H5MD element: its values, with the step and time of the positions.
  void element(const std::string& name, const char* unit, const Shape& entry, bool has_own_clock = false) const {
    group(name.c_str());
    growing((name + "/value").c_str(), H5T_NATIVE_DOUBLE, entry);
    text_attribute((name + "/value").c_str(), "unit", unit);
    if (has_own_clock) {
      growing((name + "/step").c_str(), H5T_NATIVE_INT64, {});
      growing((name + "/time").c_str(), H5T_NATIVE_DOUBLE, {});
      text_attribute((name + "/time").c_str(), "unit", "s");
      return;
    }
    for (const std::string clock : {"/step", "/time"})
      require(H5Lcreate_hard(file, (clock_ + clock).c_str(), file, (name + clock).c_str(), H5P_DEFAULT, H5P_DEFAULT));
  }

  std::filesystem::path path;
  Handle file;
  hsize_t frames = 0;
  hsize_t particle_count;
  const std::string clock_ = "/particles/soil/position";
};

MotionFile::File::File(std::filesystem::path at, const Case& setup, const Particles& particles)
    : path(std::move(at)), file(create(path), H5Fclose, path), particle_count(particles.count()) {
  const std::array<int, 2> h5md_version{1, 1};
  group("/h5md");
  attribute("/h5md", "version", H5T_NATIVE_INT, h5md_version.data(), h5md_version.size());
  group("/h5md/author");
  text_attribute("/h5md/author", "name", "crossdem");
  group("/h5md/creator");
  text_attribute("/h5md/creator", "name", "native");
  text_attribute("/h5md/creator", "version", version_line());

  group("/particles/soil/box");
  const int dimension = 2;
  attribute("/particles/soil/box", "dimension", H5T_NATIVE_INT, &dimension, 1);
  const Handle boundary_type(H5Tcopy(H5T_C_S1), H5Tclose, path);
  require(H5Tset_size(boundary_type, 4));
  require(H5Tset_cset(boundary_type, H5T_CSET_UTF8));
  attribute("/particles/soil/box", "boundary", boundary_type, "nonenone", 2);
  const std::array<double, 2> edges{setup.container.width, setup.container.height};
  whole("/particles/soil/box/edges", H5T_NATIVE_DOUBLE, {2}, edges.data());
  text_attribute("/particles/soil/box/edges", "unit", "m");
  whole("/particles/soil/radius", H5T_NATIVE_DOUBLE, {particle_count}, particles.radius.data());
  text_attribute("/particles/soil/radius", "unit", "m");
  std::vector<std::int64_t> ids(particle_count);
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<std::int64_t>(i);
  whole("/particles/soil/id", H5T_NATIVE_INT64, {particle_count}, ids.data());

  element(clock_, "m", {particle_count, 2}, true);
  element("/particles/soil/velocity", "m s-1", {particle_count, 2});
  element("/particles/soil/angle", "rad", {particle_count});
  element("/particles/soil/angular_velocity", "rad s-1", {particle_count});
  if (setup.bar) element("/observables/bar/tip", "m", {});
}

void MotionFile::File::frame(long step, double time, std::optional<double> bar_tip, const Particles& particles) {
  static_assert(sizeof(Vector2) == 2 * sizeof(double), "positions are written as pairs of doubles");
  const std::int64_t step_number = step;
  append("/particles/soil/position/step", H5T_NATIVE_INT64, {}, &step_number);
  append("/particles/soil/position/time", H5T_NATIVE_DOUBLE, {}, &time);
  append("/particles/soil/position/value", H5T_NATIVE_DOUBLE, {particle_count, 2}, particles.position.data());
  append("/particles/soil/velocity/value", H5T_NATIVE_DOUBLE, {particle_count, 2}, particles.velocity.data());
  append("/particles/soil/angle/value", H5T_NATIVE_DOUBLE, {particle_count}, particles.angle.data());
  append("/particles/soil/angular_velocity/value", H5T_NATIVE_DOUBLE, {particle_count}, particles.spin.data());
  if (bar_tip) append("/observables/bar/tip/value", H5T_NATIVE_DOUBLE, {}, &*bar_tip);
  ++frames;
  require(H5Fflush(file, H5F_SCOPE_GLOBAL));
}

MotionFile::MotionFile(const std::filesystem::path& path, const Case& setup, const Particles& particles)
    : file_(std::make_unique<File>(path, setup, particles)) {}
MotionFile::~MotionFile() = default;

void MotionFile::frame(long step, double time, std::optional<double> bar_tip, const Particles& particles) {
  file_->frame(step, time, bar_tip, particles);
}

}  // namespace crossdem
