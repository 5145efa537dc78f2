// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
//
// distances FILE <POINTS: how far points are from a model's surface. A point is three numbers, in
// metres and the source mesh's frame; of each one a line: distance, side, nearest place.
#include <cstdio>
#include <tactus/transport/store/static_model.hpp>
#include <vector>

int main(int argc, char** argv)
{
    if (argc != 2)
    {
        std::fprintf(stderr, "usage: distances FILE <POINTS\n");
        return 3;
    }
    const auto model = tactus::StaticModel::open(argv[1]);
    if (!model)
    {
        std::fprintf(stderr, "distances: %s\n", model.error().text.c_str());
        return 2;
    }
    std::vector<tactus::Vec3> points_m;
    for (double x = 0, y = 0, z = 0; std::scanf("%lf %lf %lf", &x, &y, &z) == 3;)
    {
        points_m.emplace_back(x, y, z);
    }
    std::vector<tactus::PointDistance> answers(points_m.size());
    if (const auto asked = model.value()->distances(points_m, answers); !asked)
    {
        std::fprintf(stderr, "distances: %s\n", asked.error().text.c_str());
        return 2;
    }
    for (const tactus::PointDistance& answer : answers)
    {
        const tactus::Vec3& near_m = answer.nearest_m;
        std::printf("%.17g %s %.17g %.17g %.17g\n", answer.upper_m,
                    answer.side == tactus::Side::inside ? "inside" : "not-inside", near_m.x(),
                    near_m.y(), near_m.z());
    }
    return 0;
}
