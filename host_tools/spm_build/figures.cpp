// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_build/figures.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace tactus::spm_build
{

nlohmann::json figures_of(const BuiltModel& model)
{
    const HeaderFields& fields = model.fields;
    const double quantum_m = std::ldexp(1.0, fields.quantum_log2);
    const ModelCounts counts{fields.base_vertices, fields.base_faces, fields.records};
    const double faces = fields.source_faces;
    return {
        {"faces", fields.source_faces},
        {"vertices", fields.source_vertices},
        {"records", fields.records},
        {"rounds", fields.rounds},
        {"base_faces", fields.base_faces},
        {"seconds", model.seconds},
        {"faces_per_second", faces / model.seconds},
        {"peak_bytes", model.peak_bytes},
        {"file_bytes", fields.file_bytes},
        {"metres_per_unit", model.metres_per_unit},
        {"bytes_per_face", static_cast<double>(fields.file_bytes) / faces},
        {"quantisation_diag", fields.quantisation_m / model.diagonal_m},
        {"e_max_diag", fields.max_error_quanta * quantum_m / model.diagonal_m},
        {"hausdorff_diag_sampled", model.sampled_distance_m / model.diagonal_m},
        {"regions", fields.occupied_regions},
        {"chunks", counts.chunks()},
    };
}

} // namespace tactus::spm_build
