// Files whose writers notice a full disk: every byte is accounted for, a finished file is complete.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ligament::core
{
/// A buffered file opened for writing. Every failure of the system throws EnvironmentError with
/// path and reason. Mode::replace writes beside the target and renames in commit(), so that no
/// reader ever meets half a file; without commit() the target stays as it was. Mode::stream starts
/// the file anew and can be read while it grows, Mode::append continues it. Targets that are not
/// regular files (devices, pipes) are written in place.
class OutputFile
{
public:
  enum class Mode
  {
    replace,
    stream,
    append
  };

  explicit OutputFile(std::string path, Mode mode = Mode::replace);
  /// Does not throw; what a growing file still holds is written if possible.
  ~OutputFile();
  OutputFile(const OutputFile &) = delete;
  OutputFile &operator=(const OutputFile &) = delete;

  void write(std::string_view text);
  /// Hands the buffer to the system.
  void flush();
  /// Flushes and waits for the disk.
  void sync();
  /// Flushes, waits for the disk, closes and puts the file in its place.
  void commit();

  const std::string &path() const { return path_; }

private:
  [[noreturn]] void fail(const std::string &action) const;
  void write_through(std::string_view text);

  std::string path_;
  std::string written_path_; // path_ itself, or the temporary beside it
  std::string buffer_;
  int descriptor_ = -1;
  bool renames_ = false;
};

/// Replaces the whole file at once.
void write_file(const std::string &path, std::string_view text);

/// Takes off what follows the first bytes. InputError when the file has fewer.
void cut_file(const std::string &path, std::int64_t bytes);

/// The whole file; EnvironmentError when it cannot be read.
std::string read_file(const std::string &path);
} // namespace ligament::core
