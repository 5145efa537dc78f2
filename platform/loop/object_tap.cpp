// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/object_tap.hpp"

#include <algorithm>

namespace tactus::hrtc
{

void ObjectTap::copy(const ObjectTable& objects, std::span<const PairOutput> pairs) noexcept
{
    if (was_sent_)
    {
        copy_.sweep_begin = copy_.sweep_end < objects.capacity() ? copy_.sweep_end : 0;
    }
    copy_.sweep_end = std::min(copy_.sweep_begin + kObjectSweep, objects.capacity());
    copy_.objects.clear();
    for (std::uint32_t number = copy_.sweep_begin; number < copy_.sweep_end; ++number)
    {
        add(objects, number);
    }
    for (const PairOutput& pair : pairs)
    {
        const auto listed = copy_.objects.view();
        if (std::ranges::find(listed, pair.object, &ObjectsCopy::Object::number) == listed.end())
        {
            add(objects, pair.object);
        }
    }
}

void ObjectTap::add(const ObjectTable& objects, std::uint32_t number) noexcept
{
    const Object& object = objects[number];
    if (object.is_resident)
    {
        copy_.objects.push_back({number, object.spec.model.value, object.pose});
    }
}

} // namespace tactus::hrtc
