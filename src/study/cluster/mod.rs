//! Studies on many computers: shards, and the scripts of batch systems. In: a number of runs. Out: the part of each process. It runs
//! nothing.

pub mod shard;
pub mod slurm;
