# SPDX-License-Identifier: Apache-2.0
# The layers of the project as data: which module may include which. cmake/checks/guards.py reads
# this file and fails on every #include that breaks it. It knows the three commands below, ${lists}
# and comments, nothing else of CMake.
#
# A module is a folder (or one file). A file belongs to the module with the longest matching path. A
# module may always include itself; an allowed name also allows the modules below it ("rt_core"
# means every module of rt_core); "*" allows everything.
#
# tactus_module(<path> <allowed module>...)
# tactus_external(<first part of the include's path> <module>...): a library's headers and the only
# modules (with the modules below them) that may include them.
# set(<list> <word>...)

# --- rt_core: stages are siblings and never include one another; they meet in query, refine, frame.
# Except that the forest hands each change straight to the tree
# (docs/internals/decisions/0005-the-frame.md).
set(stage_layer
    rt_core/base rt_core/math rt_core/limits.hpp rt_core/geometry rt_core/records rt_core/spm)

tactus_module(rt_core/base)
tactus_module(rt_core/math rt_core/base rt_core/math/seen_triangle.hpp)
# A record without inline functions: all of math that a kernel set may see.
tactus_module(rt_core/math/seen_triangle.hpp rt_core/base)
tactus_module(rt_core/geometry rt_core/base rt_core/math rt_core/limits.hpp)
tactus_module(rt_core/limits.hpp rt_core/base)
tactus_module(rt_core/spm rt_core/base rt_core/math rt_core/limits.hpp)
tactus_module(rt_core/records
    rt_core/base rt_core/math rt_core/limits.hpp rt_core/geometry rt_core/spm)
tactus_module(rt_core/cache ${stage_layer} rt_core/kernels)
tactus_module(rt_core/kernels rt_core/base rt_core/limits.hpp rt_core/math/seen_triangle.hpp)
tactus_module(rt_core/abtree ${stage_layer} rt_core/kernels)
tactus_module(rt_core/forest ${stage_layer} rt_core/abtree rt_core/kernels)
tactus_module(rt_core/predict ${stage_layer})
tactus_module(rt_core/force ${stage_layer} rt_core/kernels rt_core/query/probe.hpp)
tactus_module(rt_core/scene ${stage_layer})
tactus_module(rt_core/query ${stage_layer} rt_core/abtree rt_core/kernels rt_core/query/probe.hpp)
# How kernels see a place: what asks a tree and what moves among its faces both do.
tactus_module(rt_core/query/probe.hpp rt_core/kernels rt_core/limits.hpp rt_core/math)
tactus_module(rt_core/refine ${stage_layer}
    rt_core/abtree rt_core/forest rt_core/kernels rt_core/cache rt_core/query)
tactus_module(rt_core/frame rt_core)

# --- What every module above rt_core may use.
tactus_module(platform/base rt_core/base)

# --- platform: only the controller program sees core, transport and device; nothing includes it.
set(platform_layer
    platform/base rt_core/base rt_core/math rt_core/geometry rt_core/records rt_core/limits.hpp)

tactus_module(platform ${platform_layer})
# What devices say of themselves is judged where the rule is that uses it.
tactus_module(platform/remote platform ${platform_layer} rt_core/force)
tactus_module(platform/udp platform ${platform_layer})
tactus_module(platform/dhd platform ${platform_layer})
tactus_module(platform/plugin platform ${platform_layer})
# Frames and what they were given; of the machine it knows nothing.
tactus_module(platform/recording platform/base rt_core)
# Recordings for other tools.
tactus_module(platform/export platform/base platform/recording rt_core)
# What the machine is like; of frames and models it knows nothing.
tactus_module(platform/doctor platform)
# Pages; of what was measured it knows nothing.
tactus_module(platform/plot)
# Its command line and a scene's file are read like every other program's:
# docs/internals/decisions/0003-command-line-room.md.
tactus_module(platform/hrtc rt_core transport platform host_tools/cli host_tools/mesh
    host_tools/scene)

# --- transport: parse and link live in spm; of the cache it knows inbox and page slots.
tactus_module(transport ${stage_layer} rt_core/cache platform/base)

# What a frame and the courier beside it take together.
tactus_module(transport/pool_plan.hpp rt_core)
tactus_module(transport/pool_plan.cpp rt_core transport)
# A frame that refines all of a model, once.
tactus_module(transport/store/static_model.cpp rt_core transport platform/base)

# --- host_tools: downward only; nothing includes a program.
set(host_layer platform/base rt_core transport)

tactus_module(host_tools/cli platform/base)
tactus_module(host_tools/mesh ${host_layer})
tactus_module(host_tools/scene ${host_layer} host_tools/mesh)
tactus_module(host_tools/shapes ${host_layer} host_tools/mesh)
tactus_module(host_tools/simplify ${host_layer} host_tools/mesh)
tactus_module(host_tools/encode ${host_layer} host_tools/mesh host_tools/simplify)
tactus_module(host_tools/web ${host_layer})
# The library for other languages.
tactus_module(host_tools/c ${host_layer})
tactus_module(host_tools/python host_tools/c)
tactus_module(host_tools/spm_build ${host_layer}
    host_tools/cli host_tools/mesh host_tools/scene host_tools/shapes host_tools/simplify
    host_tools/encode)
tactus_module(host_tools/spm_inspect ${host_layer} host_tools/cli host_tools/mesh host_tools/encode)
tactus_module(host_tools/spm_publish ${host_layer} host_tools/cli host_tools/mesh host_tools/scene
    host_tools/web)

# It plays recordings.
tactus_module(host_tools/spm_view ${host_layer} host_tools/cli host_tools/mesh host_tools/encode
    host_tools/web platform/recording)

tactus_module(tests *)

# --- Libraries of others.
tactus_external(dds transport/dds tests)
tactus_external(ccd rt_core/query tests)
tactus_external(Eigen rt_core platform transport host_tools tests)
tactus_external(CLI host_tools/cli)
tactus_external(nlohmann platform/doctor platform/hrtc platform/plot host_tools tests)
tactus_external(fmt platform/doctor platform/export platform/plot platform/hrtc transport host_tools
    tests)
tactus_external(assimp host_tools/mesh tests)
tactus_external(tbb host_tools tests)
# The only doors that speak HTTP.
tactus_external(httplib.h host_tools/spm_view host_tools/web)
tactus_external(oneapi host_tools tests)
tactus_external(pybind11 host_tools/python)
tactus_external(gtest tests)
tactus_external(rapidcheck tests)
# libsodium's one header; rt_core must not hash with it, since it may allocate.
tactus_external(sodium.h transport host_tools platform/hrtc tests)

# --- Standard headers of rt_core: nothing that brings a heap, a clock, a thread, a file or a throw.
set(TACTUS_RT_CORE_STANDARD_HEADERS
    algorithm array atomic bit climits cmath compare concepts cstddef cstdint cstring
    initializer_list iterator limits new numbers numeric optional span string_view tuple
    type_traits utility variant immintrin.h)
