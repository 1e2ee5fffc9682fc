// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Before a function with loops over many points: it is compiled for AVX2, too, and the loader
/// takes what the processor has. AVX2 comes without fused multiply-add, so the results are the same
/// bits. Not with sanitizers, whose runtime is not ready when the loader asks.
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define BEAUTYMAP_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define BEAUTYMAP_VECTOR_CLONES
#endif
