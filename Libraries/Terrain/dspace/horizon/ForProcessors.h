// Functions that are compiled for several processors.
#ifndef DSPACE_TERRAIN_FOR_PROCESSORS_H
#define DSPACE_TERRAIN_FOR_PROCESSORS_H

// Before a function: it is compiled for two processors, without fused multiplications, so that both
// give the same bits. Its loops should have no branches, so that compilers vectorize them.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
    !defined(__SANITIZE_ADDRESS__)
#define DSPACE_FOR_PROCESSORS __attribute__((target_clones("avx2", "default")))
#else
#define DSPACE_FOR_PROCESSORS
#endif

#endif
