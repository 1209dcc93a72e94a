autocmd BufRead,BufNewFile *.psd setfiletype psd
