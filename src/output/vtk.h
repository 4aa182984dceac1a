// Fields for ParaView: particles (VTP), cells (VTU), broken bonds (VTP), one collection (PVD).
#pragma once

#include "src/output/fields.h"
#include "src/output/run_folder.h"

#include <string>
#include <utility>
#include <vector>

namespace ligament::program
{
/// XML with inline base64 blocks, compressed by zlib at its fastest level, 64-bit headers. Units
/// are written where ParaView shows them. All writers throw EnvironmentError when the disk refuses
/// and never leave half a file. Points are reference positions: warp by `displacement`.
void write_particles_vtp(const std::string &path, const ParticleFields &particles);
/// The particles of these files as one set; they have the fields of `like`, and lie beside `path`.
void write_particles_pvtp(const std::string &path, const ParticleFields &like,
                          const std::vector<std::string> &files);
void write_cells_vtu(const std::string &path, const CellFields &cells);

/// One segment (2D) or square (3D) per broken face, with time, normal, energy and size.
void write_broken_bonds_vtp(const std::string &path, const std::vector<BrokenBond> &bonds,
                            int dimension);

/// Files of a state, relative to the output folder; empty: the state has no such part.
struct StateFiles
{
  std::string particles, cells;
};

/// Of the particles of a state, which several ranks write, each the ones it has.
struct Piece
{
  int number = 0;
  int of = 1;
};

/// Collection of all times and parts; rewritten after every time so that it can be opened while the
/// run goes on. Part 0 particles, 1 cells, 2 broken bonds.
class FieldSeries
{
public:
  FieldSeries(RunFolder folder, int dimension);

  /// Writes fields/{particles,cells,broken_bonds}_NAME.vt?, of atoms fields/atoms_NAME.xyz, and the
  /// .pvd; a state without a name has the next number. Empty parts are left out. Of two states of
  /// one time the later one written counts. Of several pieces all but the first write
  /// fields/particles_NAME_PIECE.vtp alone; the first one its own and all else, with
  /// fields/particles_NAME.pvtp for all of them.
  void write(const BodyState &state, const Piece &piece = {});

  /// Of the numbered states so far, in their order.
  const std::vector<double> &times() const { return times_; }
  /// Goes on behind the states of these times, whose files are there with these parts. Not to be
  /// called behind write().
  void go_on(const std::vector<double> &times, bool has_particles, bool has_cells);
  /// The same of a series that writes pieces other than the first.
  void count_on(const std::vector<double> &times) { times_ = times; }

  static StateFiles files(const BodyState &state, const std::string &name, const Piece &piece = {});

private:
  struct Entry
  {
    double time;
    int part;
    std::string file; // relative to the .pvd
  };
  void write_particles(const BodyState &state, const std::string &name, const Piece &piece) const;
  void add(double time, int part, const std::string &file);
  /// The entries of a state.
  void add(double time, const std::string &name, const StateFiles &files);
  void write_collection() const;

  RunFolder folder_;
  int dimension_;
  std::vector<double> times_;  // s, of numbered states
  std::vector<Entry> entries_; // in the order of their times
};
} // namespace ligament::program
