#include "study/study_folder.h"

#include "core/errors.h"

#include <filesystem>

namespace sandflow {

void makeStudyFolder(const std::string& path)
{
    namespace fs = std::filesystem;
    std::error_code error;
    if (fs::exists(fs::symlink_status(path, error))) {
        throw InputError(
            fmt::format("--out {}: it exists already: name a folder that does not", path));
    }
    fs::create_directories(path, error);
    if (error) {
        throw SystemError(fmt::format("cannot make the folder {}: {}", path, error.message()));
    }
}

}  // namespace sandflow
