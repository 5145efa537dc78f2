// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

// 1 in a build with this sanitizer of g++ or clang, otherwise 0: TACTUS_HAS_ADDRESS_SANITIZER,
// TACTUS_HAS_THREAD_SANITIZER.
#if defined(__has_feature)
#define TACTUS_HAS_ADDRESS_SANITIZER __has_feature(address_sanitizer)
#define TACTUS_HAS_THREAD_SANITIZER __has_feature(thread_sanitizer)
#else
#if defined(__SANITIZE_ADDRESS__)
#define TACTUS_HAS_ADDRESS_SANITIZER 1
#else
#define TACTUS_HAS_ADDRESS_SANITIZER 0
#endif
#if defined(__SANITIZE_THREAD__)
#define TACTUS_HAS_THREAD_SANITIZER 1
#else
#define TACTUS_HAS_THREAD_SANITIZER 0
#endif
#endif
