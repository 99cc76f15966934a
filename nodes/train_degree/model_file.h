// What was learned, as a file: trained once, taken along to a farm or to another shot.
//
// A line that says what it is and of which version, the model's bytes (types/degree_model.h, with all that it
// is valid for), and their digest: a damaged file is told from a sound one.
#pragma once

#include <string>
#include <string_view>

#include "base/exec.h"
#include "base/result.h"
#include "types/degree_model.h"

namespace sherd {

struct ModelFileParams {
  std::string file;
};

/// The content of a model's file. The same model gives the same bytes.
std::string modelBytes(const DegreeModel& model);
/// Errors (port "file"): no model; of another version; damaged.
Result<DegreeModel> modelFrom(std::string_view bytes);

/// Makes the file, and the folders that it is in, where they are missing. Errors (port "file"): what the
/// system says.
Result<void> writeModel(const DegreeModel& model, const ModelFileParams& params, const Exec& exec);
/// Errors (port "file"), with the file's name: no such file, a folder, unreadable, and those of modelFrom().
Result<DegreeModel> readModel(const ModelFileParams& params, const Exec& exec);

}  // namespace sherd
