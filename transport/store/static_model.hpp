// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/contact.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/base/refusal.hpp"
#include "transport/served_model.hpp"

#include <chrono>
#include <filesystem>
#include <memory>
#include <span>

// Thread: any. Several threads may query one model at once.
namespace tactus
{

/// Distance from a point to the surface of a model's source mesh, in metres of the source's frame.
struct PointDistance
{
    double lower_m{0.0};       ///< Lower bound of the distance.
    double upper_m{kInfinity}; ///< Upper bound; the two differ by rounding.
    /// Nearest point of the surface; one of them if there are several.
    Vec3 nearest_m{0.0, 0.0, 0.0};
    Side side{Side::unsigned_distance};
};

/// A whole model, refined to its source mesh: distance queries without tools, frames and time.
class StaticModel
{
public:
    /// Opens a model's file. Refused if it cannot be read, is damaged or does not fit into memory.
    /// About 200 bytes and two microseconds a face.
    [[nodiscard]] static Result<std::unique_ptr<StaticModel>, Refusal>
    open(const std::filesystem::path& path);
    /// Loads a model from any source; refused also if nothing arrives for `patience`. The link is
    /// not used afterwards.
    [[nodiscard]] static Result<std::unique_ptr<StaticModel>, Refusal>
    load(ServedModel served, std::chrono::milliseconds patience = std::chrono::seconds(10));

    ~StaticModel();
    StaticModel(const StaticModel&) = delete;
    StaticModel& operator=(const StaticModel&) = delete;
    StaticModel(StaticModel&&) = delete;
    StaticModel& operator=(StaticModel&&) = delete;

    [[nodiscard]] const ModelHeader& header() const noexcept;

    /// Distances of points in the source's frame; `answers` has as many elements as `points_m`.
    /// Refused, with nothing written, if a point is not finite or farther than 2^36 quanta from the
    /// model's corner, some 4,000 to a million diagonals. Some microseconds a point, less if
    /// successive points are near each other.
    [[nodiscard]] Result<Done, Refusal> distances(std::span<const Vec3> points_m,
                                                  std::span<PointDistance> answers) const;

private:
    struct Parts;

    explicit StaticModel(std::unique_ptr<Parts> parts);

    std::unique_ptr<Parts> parts_;
};

} // namespace tactus
