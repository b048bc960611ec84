/*
@plant@ *
 * The observer of the model `@model@`, for C and C++. Written by pebo-gen @version@: edit the model, not
 * this file, and generate again.
 *
 * Timing. A call of @name@_step gets the output@output_s@ y at the END of an interval, and its length in
 * seconds; the estimate is that of the same instant.
@held@ *
 *   sample      y_0          y_1          y_2
 *   input        |--- u_0 ---|--- u_1 ---|
 *   call     step(y_0,u_0,_) step(y_1,u_0,T) step(y_2,u_1,T)
 *
 * The first call has no interval behind it: its period has no effect, but has to be positive. After a
 * fault the next good sample goes on from the last accepted one, with the time since that one.
 *
 * No function allocates memory, keeps a pointer, or fails in another way than by its fault. Several
 * observers do not know of one another; one is for one task at a time.
 */
#ifndef @NAME@_H
#define @NAME@_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/*
 * An observer: memory that its functions alone look into. It may be copied. Make it `static`, or zero
 * it: memory that is zero is known for no observer, and refused.
 */
#define @NAME@_WORDS @words@
typedef struct {
    uint64_t memory[@NAME@_WORDS];
} @name@;

