//! The page's function that shows the progress of a long task.

/// Reports progress: the share done from 0 to 1, or NaN if unknown, and the nodes of a search.
pub(crate) fn progress(share: f64, nodes: f64) {
    #[cfg(target_arch = "wasm32")]
    {
        // SAFETY: a function of the page that takes two numbers.
        #[link(wasm_import_module = "page")]
        unsafe extern "C" {
            #[link_name = "progress"]
            safe fn page_progress(share: f64, nodes: f64);
        }
        page_progress(share, nodes);
    }
    #[cfg(not(target_arch = "wasm32"))]
    {
        _ = (share, nodes);
    }
}
