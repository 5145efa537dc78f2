// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/header.hpp"
#include "tests/shared/random.hpp"
#include "transport/edit_content.hpp"

#include <cstdint>
#include <set>

namespace tactus::test
{

/// Sequence of random edits of one model, each of which can follow the ones before it.
struct RandomEdits
{
    RandomEdits(const ModelHeader& header, std::uint32_t room) : header_(header), room_(room) {}

    /// Most are small, every tenth is as large as the surface allows.
    [[nodiscard]] EditContent next(Random& random)
    {
        const std::uint32_t face_ids = header_.counts().face_ids();
        const std::uint32_t most = random.one_in(10) ? kMaxEditFaces : 12;
        EditContent edit;
        edit.revision = ++revision_;
        for (std::uint32_t i = random.below(most + 1); i > 0; --i)
        {
            const bool is_source = used_.empty() || random.one_in(2);
            const std::uint32_t source = random.below(face_ids);
            if (is_source && removed_.insert(source).second)
            {
                edit.removed.push_back(FaceId{source});
                edit.removed_m.add(corner(random));
            }
            else if (!is_source)
            {
                const auto at = used_.lower_bound(random.below(room_));
                const std::uint32_t slot = at == used_.end() ? *used_.begin() : *at;
                used_.erase(slot);
                edit.removed.push_back(FaceId{face_ids + slot});
            }
        }
        for (std::uint32_t i = random.below(most + 1); i > 0; --i)
        {
            const std::uint32_t slot = random.below(room_);
            if (used_.insert(slot).second)
            {
                edit.added.push_back({slot,
                                      random.below(1U << 31U),
                                      {corner(random), corner(random), corner(random)}});
            }
        }
        return edit;
    }

private:
    [[nodiscard]] Vec3f corner(Random& random) const
    {
        Vec3f corner_m{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            // Few places, so that faces share vertices.
            const std::uint32_t most = header_.fields().extent_quanta[axis];
            const std::uint32_t quanta = random.one_in(4) ? most : random.below(most / 16 + 1);
            corner_m[axis] = static_cast<float>(quanta) * header_.quantum_m();
        }
        return corner_m;
    }

    ModelHeader header_;
    std::uint32_t room_;
    std::uint32_t revision_{0};
    std::set<std::uint32_t> removed_;
    std::set<std::uint32_t> used_;
};

} // namespace tactus::test
