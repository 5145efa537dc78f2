// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/influence_index.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace tactus::test
{

namespace
{

struct BoxInQuanta
{
    std::array<double, 3> low{};
    std::array<double, 3> high{};
};

/// The same rule as for the sphere in spm/index_page.hpp.
bool meets(const BoxInQuanta& zone, const QuantumBox& box)
{
    bool overlaps = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        overlaps = overlaps && zone.low[axis] <= static_cast<double>(box.high[axis]) &&
                   zone.high[axis] >= static_cast<double>(box.low[axis]);
    }
    return overlaps;
}

QuantumSphere in_quanta(const SphereZone& zone, double per_metre)
{
    const Vec3 center = zone.center_m * per_metre;
    return {{center.x(), center.y(), center.z()}, zone.radius_m * per_metre};
}

BoxInQuanta in_quanta(const BoxZone& zone, double per_metre)
{
    const Vec3 low = zone.low_m * per_metre;
    const Vec3 high = zone.high_m * per_metre;
    return {{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}};
}

template <typename ZoneInQuanta>
InfluenceIndex::Named find_named(const ModelHeader& header, const std::vector<IndexPage>& pages,
                                 const ZoneInQuanta& zone)
{
    InfluenceIndex::Named named;
    for (std::uint32_t page = 0; page < pages.size(); ++page)
    {
        const QuantumBox box = header.index_entry({page}).box;
        if (!meets(zone, box))
        {
            continue;
        }
        named.pages.push_back({page});
        for (std::uint32_t i = 0; i < pages[page].chunks; ++i)
        {
            if (meets(zone, box_of(pages[page], box, i)))
            {
                named.chunks.push_back({(page << kChunksPerIndexPageLog2) + i});
            }
        }
    }
    return named;
}

} // namespace

InfluenceIndex::InfluenceIndex(const ModelStore& store)
    : header_(store.header()), pages_(store.header().counts().index_pages())
{
    std::vector<std::byte> coded;
    std::array<ChunkEntry, kChunksPerIndexPage> entries{};
    for (std::uint32_t page = 0; page < pages_.size(); ++page)
    {
        if (!store.read({ContentKind::index_page, page}, coded) ||
            !parse_index_page(coded, header_.counts(), {page}, pages_[page], entries))
        {
            throw std::runtime_error("an index page can't be read");
        }
    }
}

InfluenceIndex::Named InfluenceIndex::named_by(const Zone& zone_m) const
{
    const double per_metre = 1.0 / static_cast<double>(header_.quantum_m());
    return std::visit([&](const auto& zone)
                      { return find_named(header_, pages_, in_quanta(zone, per_metre)); },
                      zone_m);
}

} // namespace tactus::test
