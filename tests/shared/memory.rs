//! How much memory work takes: an allocator that counts what one thread has.

#![expect(unsafe_code, reason = "an allocator cannot be written without it")]

use rayon::prelude::*;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// Hands all on to the system's, and counts for threads that are watched.
pub(crate) struct CountingAllocator;

#[derive(Clone, Copy, Default)]
struct TakenBytes {
    now: isize,
    most: isize,
}

thread_local! {
    /// What this thread has taken and not given back since it is watched; none where it is not.
    static TAKEN: Cell<Option<TakenBytes>> = const { Cell::new(None) };
}

fn count(bytes: isize) {
    // a thread that ends has no counters any more
    let _ = TAKEN.try_with(|taken| {
        if let Some(TakenBytes { now, most }) = taken.get() {
            let now = now + bytes;
            taken.set(Some(TakenBytes { now, most: most.max(now) }));
        }
    });
}

// Sound, as the system's is: nothing is done with the memory here, and nothing is taken while it is counted.
unsafe impl GlobalAlloc for CountingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        count(-(layout.size() as isize));
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // both are there while it moves
        count(size as isize);
        count(-(layout.size() as isize));
        unsafe { System.realloc(at, layout, size) }
    }
}

/// A thread on which work runs with all that it hands to others by `rayon`, so that all it takes is counted.
pub(crate) struct CountedThread(rayon::ThreadPool);

impl CountedThread {
    pub(crate) fn new() -> Self {
        CountedThread(rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread"))
    }

    /// What work gives, and the most bytes that it had taken at a time, whether it wrote to them or not.
    pub(crate) fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> (T, u64) {
        self.0.install(|| {
            TAKEN.set(Some(TakenBytes::default()));
            let result = work();
            let taken = TAKEN.take().unwrap_or_default();
            (result, taken.most as u64)
        })
    }
}

#[test]
fn what_is_taken_is_counted_wherever_it_is_taken() {
    let thread = CountedThread::new();
    let (length, most) = thread.run(|| Vec::<u8>::with_capacity(1 << 28).capacity());
    assert!(length == 1 << 28 && (1 << 28..(1 << 28) + (1 << 20)).contains(&most), "{most}");
    let lists = || (0..64).into_par_iter().map(|_| vec![1_u8; 1 << 16]).collect::<Vec<_>>().len();
    let (_, most) = thread.run(lists);
    assert!((1 << 22..1 << 23).contains(&most), "{most}");
    // what is given back counts no more, and each run counts for itself
    let (_, most) = thread.run(|| (0..64).for_each(|_| drop(std::hint::black_box(vec![1_u8; 1 << 16]))));
    assert!((1 << 16..1 << 18).contains(&most), "{most}");
}
