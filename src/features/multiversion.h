#pragma once

// Marks a hot loop to be compiled twice, for AVX2 and for the baseline; the loader takes the better
// one for the machine at hand. Only integer arithmetic, or float arithmetic that is exact, may be
// marked: then both versions give the same result, bit by bit. Sanitizers cannot run the resolvers
// that this needs.
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__AVX2__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define CAIRN_MULTIVERSION __attribute__((target_clones("avx2", "default")))
#else
#define CAIRN_MULTIVERSION
#endif
