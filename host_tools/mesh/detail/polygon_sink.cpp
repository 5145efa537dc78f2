// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/readers.hpp"
#include "transport/base/number_form.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tactus::detail
{

void PolygonSink::add(std::span<const std::uint32_t> corners)
{
    corners_.assign(corners.begin(), corners.end());
    if (corners_.size() > 3)
    {
        corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
        while (corners_.size() > 1 && corners_.back() == corners_.front())
        {
            corners_.pop_back();
        }
    }
    smaller_ += corners_.size() < 3 ? 1U : 0U;
    if (corners_.size() > 3)
    {
        fans_.push_back({mesh_.faces.size(), static_cast<std::uint32_t>(corners_.size())});
    }
    for (std::size_t i = 2; i < corners_.size(); ++i)
    {
        mesh_.faces.push_back({corners_[0], corners_[i - 1], corners_[i]});
    }
}

void PolygonSink::finish(std::vector<std::string>& notes)
{
    std::uint64_t crossing = 0;
    std::vector<std::array<double, 3>> places;
    for (const Fan& fan : fans_)
    {
        const auto faces = std::span(mesh_.faces).subspan(fan.first_face, fan.corners - 2);
        corners_.assign({faces[0][0], faces[0][1]});
        for (const auto& face : faces)
        {
            corners_.push_back(face[2]);
        }
        places.clear();
        for (const std::uint32_t corner : corners_)
        {
            places.push_back(mesh_.positions[corner]);
        }
        const auto cut = cut_polygon(places);
        crossing += cut ? 0U : 1U;
        for (std::size_t i = 0; cut && i < cut->size(); ++i)
        {
            const auto& [a, b, c] = (*cut)[i];
            faces[i] = {corners_[a], corners_[b], corners_[c]};
        }
    }
    if (crossing > 0)
    {
        notes.push_back(
            crossing == 1
                ? "1 polygon crosses itself or has no area; cut into a fan of triangles"
                : fmt::format(
                      "{} polygons cross themselves or have no area; cut into fans of triangles",
                      crossing));
    }
    if (smaller_ > 0)
    {
        notes.push_back(counted(smaller_, "polygon") + " with fewer than 3 corners dropped");
    }
}

} // namespace tactus::detail
