// Changes of folders that are on the disk when the call returns; EnvironmentError when it refuses.
#pragma once

#include <string>
#include <vector>

namespace ligament::core
{
/// Waits until the names in the folder are on the disk.
void sync_folder(const std::string &path);

/// Inside a folder that is there; nothing may have the name.
void make_new_folder(const std::string &path);

/// Both names are in the same folder; nothing may have the new one.
void rename_folder(const std::string &from, const std::string &to);

/// Removes a folder of files.
void remove_folder(const std::string &path);

void remove_file(const std::string &path);

/// The names in a folder, sorted; none where there is no folder.
std::vector<std::string> folder_entries(const std::string &path);
} // namespace ligament::core
