"""Effects of the vocabulary: by place; forces; links, numbers and motors."""
