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

// Any thread, and several at once.
namespace tactus
{

/// Distance from a point to the surface of the source mesh, in metres in the source's frame.
struct PointDistance
{
    double lower_m{0.0};       ///< Lower bound of the distance.
    double upper_m{kInfinity}; ///< Upper bound; exceeds lower_m by rounding only.
    /// A nearest point of the surface, any one if there are several.
    Vec3 nearest_m{0.0, 0.0, 0.0};
    Side side{Side::unsigned_distance};
};

/// A model loaded as a whole and refined to its source mesh, for distance queries of points.
class StaticModel
{
public:
    /// Opens the file of a model. Refused if it cannot be read, is damaged or does not fit into
    /// memory. Takes about 200 bytes and 2 us for each face.
    [[nodiscard]] static Result<std::unique_ptr<StaticModel>, Refusal>
    open(const std::filesystem::path& path);
    /// Loads a model over its link, which is not used afterwards. Refused as by open(), and if
    /// there is no progress for `patience`.
    [[nodiscard]] static Result<std::unique_ptr<StaticModel>, Refusal>
    load(ServedModel served, std::chrono::milliseconds patience = std::chrono::seconds(10));

    ~StaticModel();
    StaticModel(const StaticModel&) = delete;
    StaticModel& operator=(const StaticModel&) = delete;
    StaticModel(StaticModel&&) = delete;
    StaticModel& operator=(StaticModel&&) = delete;

    [[nodiscard]] const ModelHeader& header() const noexcept;

    /// Sets `answers` to the distances of points in the source's frame; both spans must have the
    /// same size (asserted). Refused, with nothing written, if a point is not finite or farther
    /// than 2^36 quanta from the model's corner, 4,000 to a million diagonals. A few us for each
    /// point, less if successive points are near each other.
    [[nodiscard]] Result<Done, Refusal> distances(std::span<const Vec3> points_m,
                                                  std::span<PointDistance> answers) const;

private:
    struct Parts;

    explicit StaticModel(std::unique_ptr<Parts> parts);

    std::unique_ptr<Parts> parts_;
};

} // namespace tactus
